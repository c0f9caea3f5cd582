#include "tests/integration/device/live_loop_trace.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace bonemill::test {
namespace {

constexpr size_t kMinRows = 50;  // of a window

Eigen::Vector3d vectorAt(const std::vector<double>& cells, size_t first) {
    return {cells.at(first), cells.at(first + 1), cells.at(first + 2)};
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

struct Window {
    double force_rms, hand_rms, penetration;
    Eigen::Vector3d force, p_tool;
};

Window windowOf(const LiveRow* begin, const LiveRow* end) {
    const auto count = double(end - begin);
    const auto mean = [&](Eigen::Vector3d LiveRow::*member) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const LiveRow* row = begin; row != end; ++row) sum += row->*member;
        return Eigen::Vector3d(sum / count);
    };
    const auto rms = [&](Eigen::Vector3d LiveRow::*member, const Eigen::Vector3d& about) {
        double squares = 0;
        for (const LiveRow* row = begin; row != end; ++row) squares += (row->*member - about).squaredNorm();
        return std::sqrt(squares / count);
    };
    Window window{};
    window.force = mean(&LiveRow::force);
    window.p_tool = mean(&LiveRow::p_tool);
    window.force_rms = rms(&LiveRow::force, window.force);
    window.hand_rms = rms(&LiveRow::p_hand, mean(&LiveRow::p_hand));
    for (const LiveRow* row = begin; row != end; ++row)
        window.penetration = std::max(window.penetration, row->penetration);
    return window;
}

// Those in which most ticks are missing are left out.
std::vector<Window> windowsOf(const std::vector<LiveRow>& rows, double from, double until) {
    std::vector<Window> windows;
    const auto rowAt = [&](double t) {
        return std::lower_bound(rows.data(), rows.data() + rows.size(), t,
                                [](const LiveRow& row, double time) { return row.t < time; });
    };
    for (double t = from; t + kWindow <= until; t += kWindow) {
        const LiveRow *const begin = rowAt(t), *const end = rowAt(t + kWindow);
        if (size_t(end - begin) >= kMinRows) windows.push_back(windowOf(begin, end));
    }
    return windows;
}

}  // namespace

std::vector<LiveRow> liveRowsOf(const std::string& trace) {
    std::istringstream lines(trace);
    std::string line;
    std::getline(lines, line);
    std::vector<LiveRow> rows;
    while (std::getline(lines, line)) {
        std::vector<double> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(std::stod(cell));
        rows.push_back({cells.at(0), vectorAt(cells, 1), vectorAt(cells, 8), vectorAt(cells, 15),
                        cells.at(22), uint32_t(cells.at(25))});
    }
    return rows;
}

std::optional<Engagement> firstEngagementOf(const nlohmann::json& report, double end) {
    std::optional<Engagement> first;
    for (const auto& change : report.value("device_states", nlohmann::json::array())) {
        if (first) return Engagement{first->begin, change.at("t_s")};
        if (change.at("state") == "engaged") first = Engagement{change.at("t_s"), end};
    }
    return first;
}

std::vector<std::string> causesOf(const nlohmann::json& report) {
    std::vector<std::string> causes;
    for (const auto& change : report.value("device_states", nlohmann::json::array()))
        if (change.contains("cause")) causes.push_back(change.at("cause"));
    return causes;
}

double lateShareOf(const std::vector<LiveRow>& rows, const Engagement& time) {
    size_t ticks = 0, late = 0;
    for (size_t i = 1; i < rows.size(); ++i) {
        if (rows[i].t < time.begin || rows[i].t > time.end) continue;
        ++ticks;
        if (rows[i].t - rows[i - 1].t > kLate) ++late;
    }
    return ticks == 0 ? 1 : double(late) / double(ticks);
}

RestFigures restFiguresOf(const std::vector<LiveRow>& rows, double from, double until) {
    const std::vector<Window> windows = windowsOf(rows, from, until);
    const auto medianOf = [&](auto&& figure) {
        std::vector<double> values;
        for (const Window& window : windows) values.push_back(figure(window));
        return median(std::move(values));
    };
    RestFigures figures;
    figures.windows = windows.size();
    figures.force_rms = medianOf([](const Window& w) { return w.force_rms; });
    figures.hand_rms = medianOf([](const Window& w) { return w.hand_rms; });
    figures.penetration = medianOf([](const Window& w) { return w.penetration; });
    for (int i = 0; i < 3; ++i) {
        figures.force[i] = medianOf([i](const Window& w) { return w.force[i]; });
        figures.p_tool[i] = medianOf([i](const Window& w) { return w.p_tool[i]; });
    }
    return figures;
}

}  // namespace bonemill::test

#include "haptic_server/recording/statistics/tick_columns.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <span>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "common/rt/clock.h"
#include "haptic_server/core/effects/effect_figures.h"

namespace bonemill {
namespace {

using R = const TickRecord&;
using V = ColumnValue;
using Vector = std::span<const double>;

constexpr TickColumn kOfEveryTick[] = {
    {"t_s", "t_s", "s", "since the session's first tick", [](R r) -> V { return r.t_s; }},
    {"tool_p_m", "spo_px_m,spo_py_m,spo_pz_m", "m",
     "position of the simulated tool after the tick, world frame W", [](R r) -> V { return Vector(r.p_WT); }},
    {"tool_q_wxyz", "spo_qw,spo_qx,spo_qy,spo_qz", "1",
     "orientation of the simulated tool, quaternion w, x, y, z, T to W",
     [](R r) -> V { return Vector(r.q_WT); }},
    {"hand_p_m", "dev_px_m,dev_py_m,dev_pz_m", "m", "where the hand holds the tool, as accepted, W",
     [](R r) -> V { return Vector(r.p_WT_device); }},
    {"hand_q_wxyz", "dev_qw,dev_qx,dev_qy,dev_qz", "1",
     "orientation of the hand's tool, quaternion w, x, y, z, T to W",
     [](R r) -> V { return Vector(r.q_WT_device); }},
    {"force_n", "fx_n,fy_n,fz_n", "N", "force on the hand, W", [](R r) -> V { return Vector(r.f_hand_W); }},
    {"torque_nm", "tx_nm,ty_nm,tz_nm", "N m", "torque on the hand about the tool point that it holds, W",
     [](R r) -> V { return Vector(r.t_hand_W); }},
    {"buttons", nullptr, "bits", "1 removes, 2 adds", [](R r) -> V { return r.buttons; }},
    {"contacts", "contacts", "1", "samples in contact", [](R r) -> V { return r.contacts; }},
    {"penetration_m", "max_penetration_m", "m", "deepest contact",
     [](R r) -> V { return r.max_penetration; }},
    {"removed_voxels", "removed_voxels", "1", "that fell below the iso-value in this tick",
     [](R r) -> V { return r.removed_voxels; }},
    {"removed_mm3", "removed_mm3", "mm^3", "bone that fell below the iso-value in this tick",
     [](R r) -> V { return r.removed * kPerCubicMillimetre; }},
    {"added_mm3", nullptr, "mm^3", "bone that rose to the iso-value in this tick",
     [](R r) -> V { return r.added * kPerCubicMillimetre; }},
    {"faults", "faults", "bits", "TickFault bits (docs/reference/simulate.md)",
     [](R r) -> V { return r.faults; }},
    {nullptr, "tick_us", "us", "measured duration",
     [](R r) -> V { return microsecondsOfNs(double(r.compute_ns)); }},
    {"stale_factor", nullptr, "1", "share of the force while the device is silent",
     [](R r) -> V { return r.input.stale_factor; }},
    {"tool_index", nullptr, "1", "of the file's attribute tools, from 0",
     [](R r) -> V { return r.input.decisions.tool; }},
    {"device_state", nullptr, "1", "SafetyState (docs/explanation/safety.md)",
     [](R r) -> V { return r.device.state; }},
    {"periods", nullptr, "1", "of the loop that the tick stands for",
     [](R r) -> V { return uint32_t(r.input.periods); }},
};

// The last of all, where any effect tells something.
constexpr TickColumn kEvents = {
    "events", "events", "bits",
    "1 spindle stalled, 2 near a structure, 4 touched, 8 damaged, 16 bone too hot",
    [](R r) -> V { return r.effects.events; }};

std::string headerOf(const std::vector<TickColumn>& columns) {
    std::string header;
    for (const TickColumn& column : columns) header += std::string(column.trace_names) + ',';
    header.back() = '\n';
    return header;
}

std::vector<TickColumn> traceColumns(const RecordedEffects& recorded) {
    std::vector<TickColumn> columns = tickColumns(recorded);
    std::erase_if(columns, [](const TickColumn& column) { return !column.trace_names; });
    return columns;
}

template <class Number>
void append(std::string& line, Number value) {
    char text[32];  // the longest shortest double has 24 characters
    const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
    line.append(text, end).push_back(',');
}

void append(std::string& line, std::span<const double> values) {
    for (const double value : values) append(line, value);
}

std::FILE* openForWriting(const std::string& path) {
    requireNoPipe(path);
    return std::fopen(path.c_str(), "w");
}

}  // namespace

std::vector<TickColumn> tickColumns(const RecordedEffects& recorded) {
    std::vector<TickColumn> columns(std::begin(kOfEveryTick), std::end(kOfEveryTick));
    for (const EffectFigure& figure : kEffectFigures)
        if (figure.name && figure.isToldBy(recorded))
            columns.push_back({figure.name, figure.name, figure.unit, figure.description, nullptr, &figure});
    if (recorded.any()) columns.push_back(kEvents);
    return columns;
}

TraceWriter::TraceWriter(const std::string& path, const RecordedEffects& recorded)
    : columns_(traceColumns(recorded)), file_(openForWriting(path)) {
    if (!file_) {
        throw UserError("trace " + path + " cannot be written (" + std::strerror(errno) +
                        "): does its folder exist, and may you write there?");
    }
    is_good_ = std::fputs(headerOf(columns_).c_str(), file_.get()) >= 0;
}

bool TraceWriter::write(const TickRecord& record) {
    if (!is_good_ || !file_) return false;
    line_.clear();
    for (const TickColumn& column : columns_)
        std::visit([&](const auto& value) { append(line_, value); }, column.in(record));
    line_.back() = '\n';
    is_good_ = std::fwrite(line_.data(), 1, line_.size(), file_.get()) == line_.size();
    return is_good_;
}

bool TraceWriter::close() {
    if (!file_) return is_good_;
    is_good_ = std::fclose(file_.release()) == 0 && is_good_;
    return is_good_;
}

}  // namespace bonemill

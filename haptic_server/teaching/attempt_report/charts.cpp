#include "haptic_server/teaching/attempt_report/charts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "haptic_server/teaching/attempt_report/report_words.h"

namespace bonemill {
namespace {

// The box of one panel, in units of its picture.
struct Panel {
    double left, top, width, height;
    double x_max, y_min, y_max;  // what its edges stand for; x begins at 0

    double x(double value) const { return left + width * value / x_max; }
    double y(double value) const {
        return top + height * (1 - std::clamp((value - y_min) / (y_max - y_min), 0.0, 1.0));
    }
    std::string place(double at, double value) const {
        return coordinate(x(at)) + ',' + coordinate(y(value));
    }
};

std::string textAt(double x, double y, const std::string& words, const char* rest = "") {
    return "<text x='" + coordinate(x) + "' y='" + coordinate(y) + "' " + rest + ">" + escaped(words) +
           "</text>";
}

std::string svg(double width, double height, const std::string& label, const std::string& content) {
    return "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " + coordinate(width) + ' ' +
           coordinate(height) + "' role='img' aria-label='" + escaped(label) + "'>" + content + "</svg>";
}

// 1, 2 or 5 times a power of ten, not below.
double niceAbove(double value) {
    if (!(value > 0)) return 1;
    const double power = std::pow(10, std::floor(std::log10(value)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= value) return factor * power;
    return 10 * power;
}

double largestOf(const std::vector<double>& values) {
    double largest = 0;
    for (const double value : values)
        if (std::isfinite(value)) largest = std::max(largest, value);
    return largest;
}

// Lines with a gap wherever there is no value.
std::string lineOf(const Panel& panel, std::span<const double> at, std::span<const double> values,
                   const char* kind) {
    std::string path;
    bool is_down = false;
    for (size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i])) {
            is_down = false;
            continue;
        }
        path += (is_down ? 'L' : 'M') + panel.place(at[i], values[i]);
        if (!is_down) path += "h.01";  // a value alone is a dot
        is_down = true;
    }
    return path.empty() ? "" : "<path class='" + std::string(kind) + "' d='" + path + "'/>";
}

std::string frameOf(const Panel& panel, const std::string& title, const std::string& unit) {
    std::string out = "<rect class='frame' x='" + coordinate(panel.left) + "' y='" + coordinate(panel.top) +
                      "' width='" + coordinate(panel.width) + "' height='" + coordinate(panel.height) + "'/>";
    out += textAt(panel.left + 3, panel.top + 9, title, "class='title'");
    out +=
        textAt(panel.left - 3, panel.top + 7, valueText(panel.y_max, unit), "class='tick' text-anchor='end'");
    out += textAt(panel.left - 3, panel.top + panel.height, roundedText(panel.y_min),
                  "class='tick' text-anchor='end'");
    return out;
}

const SeriesTable* findTable(const Assessment& assessment, const char* id) {
    const auto found = std::ranges::find(assessment.series, id, &SeriesTable::id);
    return found == assessment.series.end() || found->index.values.empty() ? nullptr : &*found;
}

const Series* findColumn(const SeriesTable& table, const std::string& id) {
    const auto found = std::ranges::find(table.columns, id, &Series::id);
    return found == table.columns.end() ? nullptr : &*found;
}

// Not more rows than a page has room for: of two and two, the mean, the largest or the least.
enum class Of { kMean, kLargest, kMin };
std::vector<double> thinned(std::span<const double> values, size_t together, Of of) {
    std::vector<double> out;
    for (size_t first = 0; first < values.size(); first += together) {
        double sum = 0, most = -INFINITY, least = INFINITY;
        size_t count = 0;
        for (size_t i = first; i < std::min(first + together, values.size()); ++i) {
            if (!std::isfinite(values[i])) continue;
            sum += values[i], most = std::max(most, values[i]), least = std::min(least, values[i]);
            ++count;
        }
        const double mean = sum / double(count);
        out.push_back(count == 0 ? std::nan("") : of == Of::kMean ? mean : of == Of::kLargest ? most : least);
    }
    return out;
}

constexpr double kWidth = 700, kLeft = 58, kRight = 8, kPanelHeight = 42, kGap = 6, kTop = 14, kBottom = 16;
constexpr size_t kMaxPoints = 640;

std::string timeAxis(double seconds, double bottom) {
    const Panel panel{kLeft, 0, kWidth - kLeft - kRight, bottom, seconds, 0, 1};
    double step = niceAbove(seconds / 8);
    if (step > 20) step = 60 * niceAbove(step / 60);
    std::string out;
    for (double t = 0; t <= seconds * 1.0001; t += step)
        out += textAt(panel.x(t), bottom + 11, clockText(t), "class='tick' text-anchor='middle'");
    return out;
}

std::string marksOf(std::span<const Moment> marked, double begin_s, double seconds, double bottom) {
    const Panel panel{kLeft, 0, kWidth - kLeft - kRight, bottom, seconds, 0, 1};
    std::string out;
    for (size_t n = 0; n < marked.size(); ++n) {
        const double x = panel.x(std::clamp(marked[n].t_s - begin_s, 0.0, seconds));
        out += "<path class='mark' d='M" + coordinate(x) + ',' + coordinate(kTop) + 'V' + coordinate(bottom) +
               "'/>" + "<circle class='mark' cx='" + coordinate(x) + "' cy='8' r='6.5'/>" +
               textAt(x, 11, std::to_string(n + 1), "class='number' text-anchor='middle'");
    }
    return out;
}

}  // namespace

std::string timeLineSvg(const Assessment& assessment, std::span<const Moment> marked, double begin_s) {
    const SeriesTable* const table = findTable(assessment, "second");
    if (!table) return "";
    const size_t together = (table->index.values.size() + kMaxPoints - 1) / kMaxPoints;
    const std::vector<double> ends = thinned(table->index.values, together, Of::kLargest);
    const double step = ends.front(), seconds = ends.back();
    std::vector<double> middles = ends;
    for (double& middle : middles) middle -= 0.5 * step;

    std::string content;
    double top = kTop;
    const auto add = [&](const char* id, const std::string& title, const std::string& unit, const char* kind,
                         Of of) {
        const Series* const column = findColumn(*table, id);
        if (!column) return;
        const std::vector<double> values = thinned(column->values, together, of);
        if (std::ranges::none_of(values, [](double value) { return std::isfinite(value); })) return;
        const std::string largest = std::string(id) + "_max";
        const Series* const peaks = findColumn(*table, largest);
        const std::vector<double> tops = peaks ? thinned(peaks->values, together, Of::kLargest) : values;
        const double least = std::min(0.0, *std::ranges::min_element(values, [](double a, double b) {
                                          return (std::isfinite(a) ? a : 0) < (std::isfinite(b) ? b : 0);
                                      }));
        const Panel panel{kLeft,
                          top,
                          kWidth - kLeft - kRight,
                          kPanelHeight,
                          seconds,
                          std::isfinite(least) ? -niceAbove(-least) * (least < 0) : 0,
                          niceAbove(largestOf(tops))};
        content += frameOf(panel, title, unit);
        if (peaks) content += lineOf(panel, middles, tops, "peak");
        content += lineOf(panel, middles, values, kind);
        top += kPanelHeight + kGap;
    };
    add("force", "Force in contact: mean, and largest (thin)", "N", "force", Of::kMean);
    add("removed", "Removed per " + roundedText(step / double(together)) + " s", "mm3", "removed", Of::kMean);
    add("distance", "Least distance to a protected structure", "mm", "distance", Of::kMin);
    add("temperature", "Hottest bone", "degC", "heat", Of::kLargest);
    const double bottom = top - kGap;
    content += timeAxis(seconds, bottom) + marksOf(marked, begin_s, seconds, bottom);
    return svg(kWidth, bottom + kBottom, "Time line", content);
}

std::string scoreBarSvg(double score) {
    const double width = 100 * std::clamp(score, 0.0, 1.0);
    return svg(
        100, 8, "score " + roundedText(score),
        "<rect class='frame' x='.5' y='.5' width='99' height='7'/><rect class='bar' x='.5' y='.5' width='" +
            coordinate(width * 0.99) + "' height='7'/>");
}

std::string attemptsSvg(std::span<const double> values, const std::string& unit,
                        const std::optional<LearningCurve>& curve) {
    if (values.empty()) return "";
    const Panel panel{
        46, 4, 190, 70, double(values.size()) + 0.5, 0, niceAbove(*std::ranges::max_element(values))};
    std::string content = frameOf(panel, "", unit);
    if (curve) {
        std::vector<double> at, on;
        for (int n = 0; n <= 60; ++n) {
            at.push_back(1 + (double(values.size()) - 1) * n / 60.0);
            on.push_back(curve->at(at.back()));
        }
        content += lineOf(panel, at, on, "curve");
    }
    const size_t every = values.size() / 12 + 1;
    for (size_t n = 0; n < values.size(); ++n) {
        const bool is_last = n + 1 == values.size();
        content += "<circle class='" + std::string(is_last ? "dot last" : "dot") + "' cx='" +
                   coordinate(panel.x(double(n + 1))) + "' cy='" + coordinate(panel.y(values[n])) +
                   "' r='3'/>";
        if (n % every == 0 || is_last)
            content += textAt(panel.x(double(n + 1)), 84, std::to_string(n + 1),
                              "class='tick' text-anchor='middle'");
    }
    return svg(244, 90, "Attempts", content);
}

std::string distributionSvg(std::span<const double> values, const std::string& unit) {
    constexpr size_t kBins = 10;
    if (values.empty()) return "";
    const double most = unit.empty() ? 100 : niceAbove(std::ranges::max(values));
    std::array<double, kBins> counts{};
    for (const double value : values)
        ++counts[size_t(std::clamp(value / most * double(kBins), 0.0, double(kBins - 1)))];
    const Panel panel{46, 4, 190, 70, most, 0, std::ranges::max(counts)};
    std::string content = frameOf(panel, "", "");
    for (size_t bin = 0; bin < kBins; ++bin) {
        const double width = panel.width / double(kBins), height = panel.height * counts[bin] / panel.y_max;
        content += "<rect class='bar' x='" + coordinate(panel.left + width * double(bin) + 1) + "' y='" +
                   coordinate(panel.top + panel.height - height) + "' width='" + coordinate(width - 2) +
                   "' height='" + coordinate(height) + "'/>";
    }
    for (const double at : {0.0, most / 2, most})
        content += textAt(panel.x(at), 84, valueText(at, unit), "class='tick' text-anchor='middle'");
    return svg(244, 90, "Distribution", content);
}

std::string envelopeSvg(const Assessment& assessment, const ExpertComparison& comparison,
                        const std::string& column_id) {
    const SeriesTable* const table = findTable(assessment, "bucket");
    const Series* const column = table ? findColumn(*table, column_id) : nullptr;
    const auto envelope = std::ranges::find(comparison.envelopes, column_id, &Envelope::column_id);
    if (!column || envelope == comparison.envelopes.end()) return "";
    const double most = std::max(largestOf(column->values), largestOf(envelope->high));
    const Panel panel{46, 4, 190, 70, double(column->values.size()), 0, niceAbove(most)};
    std::string content = frameOf(panel, column->label, column->unit);
    std::vector<double> middles;
    for (size_t row = 0; row < column->values.size(); ++row) {
        middles.push_back(double(row) + 0.5);
        content += textAt(panel.x(middles.back()), 84, std::to_string(row + 1) + "/5",
                          "class='tick' text-anchor='middle'");
        if (!std::isfinite(envelope->low[row])) continue;
        const double high = panel.y(envelope->high[row]), low = panel.y(envelope->low[row]);
        content += "<rect class='band' x='" + coordinate(panel.x(double(row) + 0.1)) + "' y='" +
                   coordinate(high) + "' width='" + coordinate(panel.width * 0.8 / panel.x_max) +
                   "' height='" + coordinate(std::max(0.5, low - high)) + "'/>";
    }
    content += lineOf(panel, middles, column->values, "force");
    return svg(244, 90, column->label, content);
}

}  // namespace bonemill

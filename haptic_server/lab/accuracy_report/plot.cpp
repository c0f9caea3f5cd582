#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/text/printed_text.h"
#include "haptic_server/lab/accuracy_report/report_files.h"

namespace bonemill {
namespace {

using Eigen::Vector2d;

constexpr double kCharacterWidth = 8, kTextHeight = 15;  // pixels, of the plot's label font, rounded up
constexpr double kPointRadius = 6;
constexpr double kGaps[] = {3, 14, 28, 45, 65, 90};  // between point and text
constexpr double kLongestGapWithoutLine = 3;
constexpr int kDirections = 16;

struct Rectangle {
    Vector2d center, half;
    bool overlaps(const Rectangle& other) const {
        return ((center - other.center).cwiseAbs().array() < (half + other.half).array()).all();
    }
};

// The text's middle lies there when it is `gap` outside of the point in this direction.
Vector2d placeAt(const PlotLabel& label, int direction, double gap) {
    const double angle = M_PI / 4 + 2 * M_PI * direction / kDirections;  // first: right above
    const Vector2d unit(std::cos(angle), std::sin(angle));
    return label.point + unit.cwiseProduct(labelHalfSize(label.text)) + (kPointRadius + gap) * unit;
}

constexpr double kMinError = 1e-3;  // %, for the logarithm

double errorPercent(const SettingFigures& f) {
    return std::max(kMinError, 100 * f.errors.force_vector);
}

bool isPreset(const SettingFigures& f) {
    return presetOfName(f.name).has_value();
}

// Lays logarithmic axes on the picture: pixels, with the origin at the lower left.
struct Axes {
    static constexpr double kWidth = 1500, kHeight = 850;
    static constexpr double kLeft = 0.06, kRight = 0.65, kBottom = 0.09, kTop = 0.93;  // of the picture
    double x_low = INFINITY, x_high = 0, y_low = INFINITY, y_high = 0;

    explicit Axes(const ReportData& data) {
        for (const SettingFigures& f : data.settings) {
            x_low = std::min(x_low, f.times.p99_9 / 1.3), x_high = std::max(x_high, f.times.p99_9 * 1.4);
            y_low = std::min(y_low, errorPercent(f) / 2), y_high = std::max(y_high, errorPercent(f) * 2);
        }
        if (data.budget_us)
            x_low = std::min(x_low, *data.budget_us / 1.1), x_high = std::max(x_high, *data.budget_us * 1.1);
    }
    Eigen::Vector2d pixel(double x, double y) const {
        const double u = std::log(x / x_low) / std::log(x_high / x_low);
        const double v = std::log(y / y_low) / std::log(y_high / y_low);
        return {kWidth * (kLeft + u * (kRight - kLeft)), kHeight * (kBottom + v * (kTop - kBottom))};
    }
};

std::string labels(const ReportData& data, const Axes& axes) {
    std::vector<PlotLabel> all;
    for (size_t n = 0; n < data.settings.size(); ++n) {
        const SettingFigures& f = data.settings[n];
        all.push_back({.point = axes.pixel(f.times.p99_9, errorPercent(f)),
                       .text = isPreset(f) ? f.name : std::to_string(n + 1)});
    }
    layOutLabels(all);
    std::ostringstream text;
    const auto screen = [](const Eigen::Vector2d& p) {
        std::ostringstream place;
        place << "screen " << p.x() / Axes::kWidth << ", screen " << p.y() / Axes::kHeight;
        return place.str();
    };
    for (const PlotLabel& label : all) {
        text << "set label " << sceneText(label.text) << " at " << screen(label.center)
             << " center noenhanced font \",10\" front\n";
        if (label.needs_line)
            text << "set arrow from " << screen(label.point) << " to " << screen(label.center)
                 << " nohead lc rgb \"#b0b0b0\" back\n";
    }
    return text.str();
}

// The chosen settings become a block of data, p99.9 and error each, and what draws it; gnuplot wants no empty
// one.
class PlottedSeries {
  public:
    template <class Choose>
    void add(const char* name, const char* style, const ReportData& data, Choose&& choose) {
        std::vector<std::pair<double, double>> points;
        for (size_t n = 0; n < data.settings.size(); ++n)
            if (choose(n)) points.emplace_back(data.settings[n].times.p99_9, errorPercent(data.settings[n]));
        if (points.empty()) return;
        std::sort(points.begin(), points.end());
        blocks_ << '$' << name << " << END_OF_DATA\n";
        for (const auto& [time, error] : points) blocks_ << time << ' ' << error << '\n';
        blocks_ << "END_OF_DATA\n";
        plot_ += std::string(plot_.empty() ? "plot $" : ", \\\n $") + name + " using 1:2 with " + style;
    }
    std::string blocks() const { return blocks_.str(); }
    std::string plot() const { return plot_ + '\n'; }

  private:
    std::ostringstream blocks_;
    std::string plot_;
};

// Says beside the plot what the numbers stand for.
std::string legend(const ReportData& data) {
    std::ostringstream text;
    const double line = 0.84 / double(std::max<size_t>(24, data.settings.size()));
    for (size_t n = 0; n < data.settings.size(); ++n) {
        const SettingFigures& f = data.settings[n];
        const std::string number = isPreset(f) ? "" : std::to_string(n + 1) + "  ";
        text << "set label " << sceneText(number + f.name + (f.is_in_force ? "  (in force)" : ""))
             << " at screen 0.665, screen " << 0.92 - double(n) * line << " left noenhanced font \",10\"\n";
    }
    return text.str();
}

std::string settingsOfPicture(const ReportData& data, const Axes& axes, const std::filesystem::path& png) {
    std::ostringstream script;
    script << "set terminal pngcairo size " << Axes::kWidth << ',' << Axes::kHeight
           << " font \"DejaVu Sans,11\"\nset output " << sceneText(png.string()) << "\nset title "
           << sceneText(data.scene + ": force error against tick time") << " noenhanced font \",14\"\n";
    script << "set lmargin at screen " << Axes::kLeft << "\nset rmargin at screen " << Axes::kRight
           << "\nset bmargin at screen " << Axes::kBottom << "\nset tmargin at screen " << Axes::kTop << '\n';
    script
        << "set logscale xy\nset xrange [" << axes.x_low << ':' << axes.x_high << "]\nset yrange ["
        << axes.y_low << ':' << axes.y_high
        << "]\n"
           "set xtics (1,2,3,5,7,10,15,20,30,50,70,100,150,200,300,500,700,1000,1500,2000,3000,5000,10000)\n"
           "set ytics (0.001,0.002,0.005,0.01,0.02,0.05,0.1,0.2,0.5,1,2,5,10,20,50,100,200,500,1000)\n"
           "set grid lc rgb \"#d0d0d0\"\nset key bottom left Left reverse samplen 2 opaque\n"
           "set xlabel \"tick, p99.9, µs (this machine)\"\n"
           "set ylabel \"force error against truth, % (RMS)\"\n";
    if (data.budget_us)
        script << "set arrow from " << *data.budget_us << ", graph 0 to " << *data.budget_us
               << ", graph 1 nohead dt 2 lc rgb \"#c04040\"\nset label \"budget\" at " << *data.budget_us
               << ", graph 0.97 right offset -0.5,0 tc rgb \"#c04040\"\n";
    return script.str();
}

}  // namespace

Eigen::Vector2d labelHalfSize(const std::string& text) {
    return {kCharacterWidth * double(text.size()) / 2, kTextHeight / 2};
}

void layOutLabels(std::vector<PlotLabel>& labels) {
    std::vector<Rectangle> taken;
    for (const PlotLabel& label : labels) taken.push_back({label.point, Vector2d::Constant(kPointRadius)});
    for (PlotLabel& label : labels) {
        const Vector2d half = labelHalfSize(label.text);
        const auto isFree = [&](const Vector2d& center) {
            return std::none_of(taken.begin(), taken.end(), [&](const Rectangle& r) {
                return r.overlaps({center, half});
            });
        };
        bool is_placed = false;
        label.center = placeAt(label, 0, kGaps[0]);
        for (const double gap : kGaps)
            for (int direction = 0; direction < kDirections && !is_placed; ++direction) {
                const Vector2d center = placeAt(label, direction, gap);
                if (!isFree(center)) continue;
                is_placed = true;
                label.center = center;
                label.needs_line = gap > kLongestGapWithoutLine;
            }
        taken.push_back({label.center, half});
    }
}

std::string paretoScript(const ReportData& data, const std::filesystem::path& png) {
    const Axes axes(data);
    const auto& all = data.settings;
    PlottedSeries series;
    series.add("front", "steps lw 2 lc rgb \"#50a060\" title \"Pareto front\"", data,
               [&](size_t n) { return bool(data.front[n]); });
    series.add("candidates", "points pt 7 ps 1.3 lc rgb \"#2050a0\" title \"gradient law\"", data,
               [&](size_t n) { return !isOtherLaw(all[n]); });
    series.add("other_laws", "points pt 9 ps 1.5 lc rgb \"#d06050\" title \"other laws: their difference\"",
               data, [&](size_t n) { return isOtherLaw(all[n]); });
    series.add("in_force", "points pt 6 ps 3 lw 2 lc rgb \"#202020\" title \"in force in the scene\"", data,
               [&](size_t n) { return all[n].is_in_force; });
    return series.blocks() + settingsOfPicture(data, axes, png) + legend(data) + labels(data, axes) +
           series.plot();
}

}  // namespace bonemill

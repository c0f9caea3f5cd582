#include "haptic_server/cases/casework/case_figures.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <vector>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"
#include "haptic_server/cases/casework/pieces_figure.h"
#include "haptic_server/scans/find_bone/value_histogram.h"

namespace bonemill {
namespace {

constexpr size_t kBins = 400;
constexpr double kWide = 50;  // times what nearly all values fill: odd values, which would leave them one bin

// A line across the figure, with its name beside it.
struct Mark {
    double value;
    std::string name, colour;
};

std::string inNumbers(double value) {
    return printed("%.6g", value);
}

Histogram shown(const RawValues& values) {
    const ValueRange& range = values.range();
    const ValueCounts counts(values);
    const Histogram all = histogramOfAll(counts, range, kBins), most = histogramOf(counts, range);
    return range.high - range.low > kWide * most.width * double(most.count.size()) ? most : all;
}

std::string nameOf(const IsoProposal& proposed) {
    return std::string("proposed, ") + wordOf(proposed.doubt);
}

std::vector<Mark> marksOf(const RawVolume& scan, const CasePlan& plan) {
    const double used = plan.mapping.iso_value;
    const char* const kUsed = "#c03020";
    std::vector<Mark> marks;
    // With a surface's own value nothing is proposed.
    const bool is_surface = scan.surface_value.has_value();
    const std::optional<IsoProposal> proposed = plan.mapping.proposed ? plan.mapping.proposed
                                                : is_surface          ? std::nullopt
                                                                      : std::optional(proposeIso(scan));
    if (proposed && proposed->value == used) {
        marks.push_back({used, "iso-value " + inNumbers(used) + " (" + nameOf(*proposed) + ")", kUsed});
    } else {
        marks.push_back(
            {used, "iso-value " + inNumbers(used) + (is_surface ? "" : " (as asked for)"), kUsed});
        if (proposed)
            marks.push_back(
                {proposed->value, inNumbers(proposed->value) + " (" + nameOf(*proposed) + ")", "#2050a0"});
    }
    if (proposed && proposed->runner_up)
        marks.push_back(
            {*proposed->runner_up, inNumbers(*proposed->runner_up) + " (the next best)", "#508050"});
    marks.push_back({plan.mapping.low, "window_low " + inNumbers(plan.mapping.low), "#707070"});
    marks.push_back({plan.mapping.high, "window_high " + inNumbers(plan.mapping.high), "#707070"});
    if (!plan.metal.pieces.empty())
        marks.push_back({plan.metal.water + kMetalHu, "metal from here on", "#8040a0"});
    return marks;
}

// Names go one below the other, to that side of their line where there is room.
std::string drawn(const std::vector<Mark>& marks, double low, double high) {
    std::ostringstream script;
    double line = 0.955;
    for (const Mark& mark : marks) {
        const double value = std::clamp(mark.value, low, high);
        const bool is_left = value < low + 0.6 * (high - low);
        script << "set arrow from " << value << ", graph 0 to " << value << ", graph 1 nohead lw 2 lc rgb \""
               << mark.colour << "\" front\nset label \"" << mark.name << "\" at " << value << ", graph "
               << line << (is_left ? " left offset 0.7,0" : " right offset -0.7,0") << " noenhanced tc rgb \""
               << mark.colour << "\" front\n";
        line -= 0.055;
    }
    return script.str();
}

namespace fs = std::filesystem;

}  // namespace

std::string histogramScript(const RawVolume& scan, const CasePlan& plan) {
    const Histogram h = shown(scan.values);
    const double low = h.low, high = h.low + h.width * double(h.count.size());
    const double margin = 0.01 * (high - low), most = std::ranges::max(h.count);
    std::ostringstream script;
    script.precision(9);
    script << "$values << END_OF_DATA\n";
    for (size_t bin = 0; bin < h.count.size(); ++bin)
        if (h.count[bin] > 0) script << h.centre(bin) << ' ' << h.count[bin] << '\n';
    script
        << "END_OF_DATA\n"
           "set terminal pngcairo size 1200,620 font \"DejaVu Sans,11\"\nset output \"histogram.png\"\n"
           "set title \"Values of the scan\" font \",14\"\nset logscale y\n"
        << "set xrange [" << low - margin << ':' << high + margin << "]\nset yrange [0.5:" << 300 * most
        << "]\nset format y \"10^{%T}\"\nset grid y lc rgb \"#e0e0e0\"\nset tics nomirror out\nset border 3\n"
        << "set style fill solid noborder\nset key tmargin right horizontal\nset boxwidth " << h.width << '\n'
        << "set xlabel \"value" << (scan.is_hounsfield ? ", HU" : "") << "\"\nset ylabel \"voxels in bins of "
        << inNumbers(h.width) << (scan.is_hounsfield ? " HU" : "") << "\"\n"
        << drawn(marksOf(scan, plan), low, high) << "iso = " << plan.mapping.iso_value
        << "\nplot $values using ($1 < iso ? $1 : NaN):2 with boxes lc rgb \"#9aa4b0\" title \"below the "
           "iso-value\", \\\n"
           " $values using ($1 >= iso ? $1 : NaN):2 with boxes lc rgb \"#d9a441\" title \"bone\"\n";
    return script.str();
}

void writeWhole(const fs::path& file, std::string_view bytes) {
    std::ofstream out(file, std::ios::binary);
    if (!out.write(bytes.data(), std::streamsize(bytes.size())).flush())
        throw UserError(file.string() + ": cannot be written; is the disk full?");
}

void writeFigures(const fs::path& folder, const RawVolume& scan, const CasePlan& plan) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw UserError(folder.string() + ": cannot be made (" + error.message() + ")");
    writeWhole(folder / "histogram.gp", histogramScript(scan, plan));
    const PiecesFigure figure = piecesFigure(scan, plan);
    writeWhole(folder / "pieces.gp", figure.script);
    for (const PiecesFigure::Picture& picture : figure.pictures)
        writeWhole(folder / picture.file,
                   {reinterpret_cast<const char*>(picture.rgb.data()), picture.rgb.size()});
}

}  // namespace bonemill

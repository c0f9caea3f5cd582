#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/base/units.h"
#include "haptic_server/lab/accuracy_report/report_files.h"

namespace bonemill {
namespace {

constexpr double kStalledBelow = 0.5;  // of the wanted volume
constexpr double kQuietBelow = 0.05;   // of the processor's time

template <class... Values>
std::string format(const char* pattern, Values... values) {
    char text[512];
    std::snprintf(text, sizeof text, pattern, values...);
    return text;
}

std::string shortFigures(const SettingFigures& f) {
    return format("force error %.3g %% (magnitude alone %.3g %%, direction %.3g°), p99.9 of the tick %.3g µs",
                  100 * f.errors.force_vector, 100 * f.errors.force, f.errors.direction / kDegree,
                  f.times.p99_9);
}

std::string nextBetterText(const ReportData& data) {
    const SettingFigures& now = data.settings[indexInForce(data)];
    const auto next = nextBetter(paretoPoints(data.settings), indexInForce(data));
    if (!next) return "No setting of the sweep has a force error that is smaller by more than 2 %.";
    const SettingFigures& better = data.settings[*next];
    const double more = better.times.p99_9 - now.times.p99_9;
    const std::string cost = more > 0
                                 ? format("costs %.3g µs more (%+.0f %%)", more, 100 * more / now.times.p99_9)
                                 : format("costs nothing: it is %.3g µs faster here", -more);
    return "The next better setting, **" + better.name + "**, " + cost +
           format(" and brings the force error from %.3g %% to %.3g %%.", 100 * now.errors.force_vector,
                  100 * better.errors.force_vector);
}

std::string budgetText(const ReportData& data) {
    const auto points = paretoPoints(data.settings);
    const auto best = bestWithin(points, *data.budget_us);
    const std::string budget = format("%g µs", *data.budget_us);
    if (best)
        return "Within " + budget + " the most accurate is **" + data.settings[*best].name +
               "**: " + shortFigures(data.settings[*best]) + ".";
    double fastest = INFINITY;
    for (const ParetoPoint& point : points)
        if (point.is_candidate) fastest = std::min(fastest, point.time);
    return "No setting fits " + budget + format(": the fastest one's p99.9 is %.3g µs here.", fastest);
}

// Names settings that look faster than they are.
std::string stalledText(const ReportData& data) {
    std::string names;
    for (const SettingFigures& f : data.settings)
        if (f.removal && f.removal->progress() < kStalledBelow)
            names += (names.empty() ? "" : ", ") + f.name + format(" (%.0f %%)", 100 * f.removal->progress());
    if (names.empty()) return {};
    return "In the milling run the burr stayed on the bone instead of cutting its way with: " + names +
           " of the wanted volume. Their times leave out much of the work of milling.";
}

// Times of a machine that does other work are bounds.
std::string loadText(const ReportData& data) {
    if (data.taken_share < kQuietBelow) return {};
    const SettingFigures& now = data.settings[indexInForce(data)];
    return format("**Other programs had %.0f %% of the processor meanwhile: times are bounds.** ",
                  100 * data.taken_share) +
           now.name +
           format(
               " has a p99.9 from %.3g µs (the shortest pass of each tick) to %.3g µs (the longest); "
               "errors are not concerned. Measure again on a quiet machine.",
               now.times.p99_9, now.longest_times.p99_9);
}

// The error at the best and at the worst of the places.
std::string placesCell(const SettingFigures& f) {
    if (!f.best_and_worst_place) return " – |";
    return format(" %.3g .. %.3g |", 100 * f.best_and_worst_place->first,
                  100 * f.best_and_worst_place->second);
}

std::string cell(double value) {
    return format(" %.3g |", value);
}

std::string settingRow(const ReportData& data, size_t n) {
    const SettingFigures& f = data.settings[n];
    std::string name = f.name;
    if (f.is_in_force) name = "**" + name + "** (in force)";
    std::string row = format("| %zu | ", n + 1) + name +
                      (data.front[n]   ? " | ✓ |"
                       : isOtherLaw(f) ? " | † |"
                                       : " | |");
    row += cell(100 * f.errors.force_vector) + placesCell(f) + cell(100 * f.errors.worst) +
           cell(100 * f.errors.force) + cell(100 * f.errors.torque) + cell(f.errors.direction / kDegree) +
           cell(kPerMicrometre * f.errors.position) + cell(kPerMilli * f.errors.rotation) +
           cell(kPerMicrometre * f.max_penetration) + cell(kPerMilli * f.noise) +
           cell(100 * f.plane.anisotropy) + cell(kPerMicro * f.closed_energy);
    row += f.removal ? cell(100 * f.removal->error()) + cell(100 * f.removal->progress()) : " – | – |";

    return row + cell(f.times.p50) + cell(f.times.p99) + cell(f.times.p99_9) + cell(f.longest_times.p99_9) +
           cell(f.times.max) + '\n';
}

std::string settingsTable(const ReportData& data) {
    constexpr const char* kColumns[] = {"force error %",
                                        "by place %",
                                        "worst tick %",
                                        "its magnitude %",
                                        "torque error %",
                                        "direction error °",
                                        "position error µm",
                                        "rotation error mrad",
                                        "deepest µm",
                                        "noise mN",
                                        "anisotropy %",
                                        "closed-path energy µJ",
                                        "removed volume error %",
                                        "of the wanted volume %",
                                        "p50 µs",
                                        "p99 µs",
                                        "p99.9 µs",
                                        "p99.9 of longest pass µs",
                                        "max µs"};
    std::string table = "| | setting | front |", rule = "|--:|---|:-:|";
    for (const char* column : kColumns) table += std::string(" ") + column + " |", rule += "--:|";
    table += '\n' + rule + '\n';
    for (size_t n = 0; n < data.settings.size(); ++n) table += settingRow(data, n);
    const TruthSummary& truth = data.truth;
    table += "| | *truth* | | 0 | 0 | 0 | 0 | 0 | 0 | 0 | 0 |" +
             cell(kPerMicrometre * truth.max_penetration) + cell(kPerMilli * truth.noise) + " |" +
             cell(kPerMicro * truth.closed_energy) + " | | | | | | |\n";
    return table;
}

std::string truthText(const ReportData& data) {
    const TruthSummary& truth = data.truth;
    std::string text =
        "**Truth.** The same contact law, stiffness per area, coupling and tick on the same trilinear "
        "surface, sampled " +
        std::to_string(truth.refinement) +
        " times as densely per axis at 2 × 2 places per contact point, with the tool's exact distances (a "
        "mesh: its grid refined 4 times), in double precision, with as many solver iterations as it takes. ";
    text += format(
        "Along the probing path its force is %.3g N (root mean square; most %.3g N), its torque %.3g N·mm "
        "(most %.3g). ",
        truth.force_rms, truth.force_max, kPerMilli * truth.torque_rms, kPerMilli * truth.torque_max);
    return text + format(
                      "Sampled half as densely it would be off by %.2g %% (force) and %.2g µm: that bounds "
                      "its own error.\n\n",
                      100 * truth.coarser.force_vector, kPerMicrometre * truth.coarser.position);
}

std::string pathText(const ReportData& data) {
    std::string text =
        "**Probing path.** Smooth closed strokes: press, slide round a loop with changing load and a few "
        "degrees of turning, let go; nothing is milled. Places:";
    const char* separator = " ";
    for (const std::string& stroke : data.truth.strokes) text += separator + stroke, separator = "; ";
    return text + ".\n\n";
}

std::string figuresText(const ReportData& data) {
    std::string text =
        "**Errors** are root mean squares over all ticks in which the true force is at least " +
        format("%g N", Errors::kFeltForce) +
        ". The *force error*, by which the settings are ranked, is the length of the difference of the force "
        "vectors; it and the errors of magnitudes are relative to the root mean square of the true ones. *By "
        "place*: the same at the best and at the worst of the places, relative to the force there. *Worst "
        "tick*: its largest value, relative to that of all. "
        "**Deepest**: contact point in the tool. **Noise**: root mean square of the force's second "
        "differences from tick to tick. **Closed-path energy**: the least that any closed stroke took from "
        "the hand; below zero a stroke gave energy out.\n\n";
    text += "**Anisotropy**: spread of the force of the burr pressed on a plane with 0.5 to 4 N over " +
            format("%d rotated and shifted voxel grids of %.3g mm", AnalyticProbe::kGrids,
                   kPerMillimetre * data.spacing) +
            ", (largest − smallest) / mean at the worst load; accuracy.csv has the error there against the "
            "closed form.\n\n";
    return text +
           "**Removed volume**: bone removed by milling into it and sideways, against the volume that the "
           "burr swept on the simulated tool's own way; beside it the share of what the burr would have "
           "swept on the device's way (little: the burr rides on the bone and does not get in).\n\n";
}

std::string timesText(const ReportData& data) {
    return "**Times** are of whole ticks, probing and milling together, on this machine (" + data.machine +
           "), one thread, not in real time. The same work runs three times and the shortest time of each "
           "tick counts, so that what other programs take does not; a live session has that on top "
           "(docs/howto/realtime.md). With the longest times instead one sees how much that was." +
           format(" Other programs had %.0f %% of the processor.", 100 * data.taken_share) +
           format(" The scene's tick has %.4g µs.\n\n", kPerMicrosecond * data.tick_period);
}

std::string otherLawsText() {
    return "**†** These are other contact laws: thesis_2012, and those of other schools "
           "(docs/explanation/laws.md). They compute another force. There is no truth of it that a finer "
           "sampling would approach. Their columns of errors show how far they are from the truth of the "
           "gradient law; they take no part in the front and are never proposed.\n\n";
}

std::string kindText(const PatchErrors& p) {
    const std::string tool =
        p.tool_distance == ToolDistance::kAnalytic ? "analytic" : "grid x" + std::to_string(p.sdf_refinement);
    return tool +
           (p.sample_spacing > 0 ? format(", %.3g µm", kPerMicrometre * p.sample_spacing) : ", points");
}

std::string patchTable(const ReportData& data) {
    std::string table =
        "## How large a contact must be\n\nThe contact alone, without the coupling that evens out: burr at a "
        "prescribed depth in a plane, over the same grids, against π κ (R − d) d². Force errors in %, root "
        "mean square over the grids; the largest, and those of the direction: patch.csv. By how finely the "
        "bone is sampled (accuracy.sample_spacing_um).\n\n| shell factor | contact circle, voxels | depth µm "
        "|";
    std::string rule = "|--:|--:|--:|", rows;
    const PatchErrors* row = nullptr;  // first of the current row
    for (const PatchErrors& p : data.patches) {
        if (!row || p.width_voxels != row->width_voxels || p.shell_factor != row->shell_factor) {
            row = &p;
            rows +=
                format("\n| %d |", p.shell_factor) + cell(p.width_voxels) + cell(kPerMicrometre * p.depth);
        }
        if (row == data.patches.data()) table += " " + kindText(p) + " |", rule += "--:|";
        rows += cell(100 * p.force_rms);
    }
    return table + '\n' + rule + rows + '\n';
}

}  // namespace

std::vector<std::string> reportConclusions(const ReportData& data) {
    const SettingFigures& now = data.settings[indexInForce(data)];
    std::vector<std::string> lines{"In force in this scene: **" + now.name + "**, " + shortFigures(now) +
                                   '.'};
    if (isOtherLaw(now)) lines.back() += " (Its error is the difference to another law's truth, see †.)";
    lines.push_back(nextBetterText(data));
    if (const std::string load = loadText(data); !load.empty()) lines.push_back(load);
    if (data.budget_us) lines.push_back(budgetText(data));
    if (const std::string stalled = stalledText(data); !stalled.empty()) lines.push_back(stalled);
    return lines;
}

std::string unfinishedText(size_t measured, size_t of) {
    return "accuracy-report has not finished: " + std::to_string(measured) + " of " + std::to_string(of) +
           " settings are measured, and in accuracy.csv\n";
}

std::string reportText(const ReportData& data) {
    std::string text = "# Accuracy and time: " + data.scene + "\n\n";
    for (const std::string& line : reportConclusions(data)) text += "- " + line + '\n';
    text += format(
        "- Voxels of %.3g mm, burr radius %.3g mm: with %.2g N the burr touches a plane over a circle of "
        "%.2g voxels; the table at the end says what so few voxels cost.\n\n",
        kPerMillimetre * data.spacing, kPerMillimetre * data.burr_radius, data.truth.force_rms,
        data.contact_width / data.spacing);
    text += "![force error against tick time](pareto.png)\n\n";
    text += settingsTable(data) + '\n';
    return text + truthText(data) + pathText(data) + figuresText(data) + timesText(data) + otherLawsText() +
           patchTable(data);
}

}  // namespace bonemill

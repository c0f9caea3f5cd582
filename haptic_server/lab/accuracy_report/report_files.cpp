#include "haptic_server/lab/accuracy_report/report_files.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/files/whole_file.h"
#include "common/text/csv_text.h"
#include "haptic_server/core/telemetry/fault_names.h"

namespace bonemill {
namespace {

bool isBetter(const ParetoPoint& a, const ParetoPoint& b) {
    return a.error <= b.error && a.time <= b.time && (a.error < b.error || a.time < b.time);
}

// Looks among the candidates with error <= most_error and time <= most_time.
std::optional<size_t> fastestBelow(std::span<const ParetoPoint> points, double most_error, double most_time) {
    std::optional<size_t> best;
    for (size_t n = 0; n < points.size(); ++n) {
        const ParetoPoint& p = points[n];
        if (!p.is_candidate || p.error > most_error || p.time > most_time) continue;
        if (!best || std::tie(p.time, p.error) < std::tie(points[*best].time, points[*best].error)) best = n;
    }
    return best;
}

using Columns = nlohmann::ordered_json;  // column name -> value, in order

void addTimes(Columns& row, const std::string& prefix, const TickTimes& times) {
    row[prefix + "p50_us"] = times.p50;
    row[prefix + "p99_us"] = times.p99;
    row[prefix + "p99_9_us"] = times.p99_9;
    row[prefix + "max_us"] = times.max;
}

Columns knobsOf(const AccuracySettings& settings) {
    return {{"contact_law", lawName(settings.law)},
            {"shell_factor", settings.shell_factor},
            {"sample_spacing_um", kPerMicrometre * settings.sample_spacing},
            {"most_samples", settings.most_samples},
            {"tool_distance", settings.tool_distance == ToolDistance::kGrid ? "grid" : "analytic"},
            {"sdf_refinement", settings.sdf_refinement},
            {"precision", settings.precision == Precision::kFloat ? "float" : "double"},
            {"iterations", settings.iterations},
            {"continuous_collision", settings.continuous_collision}};
}

Columns figuresOf(const SettingFigures& f, bool is_on_front) {
    Columns row = knobsOf(f.settings);
    row["in_force"] = f.is_in_force;
    row["on_pareto_front"] = is_on_front;
    row["force_magnitude_error_percent"] = 100 * f.errors.force;
    row["force_error_percent"] = 100 * f.errors.force_vector;
    row["force_error_worst_percent"] = 100 * f.errors.worst;
    const auto& places = f.best_and_worst_place;
    row["force_error_best_place_percent"] = places ? Columns(100 * places->first) : Columns();
    row["force_error_worst_place_percent"] = places ? Columns(100 * places->second) : Columns();
    row["torque_error_percent"] = 100 * f.errors.torque;
    row["direction_error_deg"] = f.errors.direction / kDegree;
    row["position_error_um"] = kPerMicrometre * f.errors.position;
    row["rotation_error_mrad"] = kPerMilli * f.errors.rotation;
    row["max_penetration_um"] = kPerMicrometre * f.max_penetration;
    row["noise_mn"] = kPerMilli * f.noise;
    row["plane_force_error_percent"] = isOtherLaw(f) ? Columns() : Columns(100 * f.plane.force);
    row["plane_depth_error_um"] = isOtherLaw(f) ? Columns() : Columns(kPerMicrometre * f.plane.depth);
    row["anisotropy_percent"] = 100 * f.plane.anisotropy;
    row["closed_path_energy_uj"] = kPerMicro * f.closed_energy;
    row["lowest_energy_uj"] = kPerMicro * f.lowest_energy;
    row["removed_volume_error_percent"] = f.removal ? Columns(100 * f.removal->error()) : Columns();
    row["removed_mm3"] = f.removal ? Columns(kPerCubicMillimetre * f.removal->removed) : Columns();
    row["wanted_mm3"] = f.removal ? Columns(kPerCubicMillimetre * f.removal->wanted) : Columns();
    row["swept_mm3"] = f.removal ? Columns(kPerCubicMillimetre * f.removal->swept) : Columns();
    addTimes(row, "tick_", f.times);
    addTimes(row, "probing_", f.probing_times);
    addTimes(row, "milling_", f.milling_times);
    addTimes(row, "longest_", f.longest_times);
    row["ticks"] = f.ticks;
    row["faults"] = faultNames(f.faults);
    return row;
}

// Numbers have 6 digits, and null is nothing.
std::string cellOf(const Columns& value) {
    if (value.is_null()) return "";
    if (value.is_string()) return value.get<std::string>();
    if (!value.is_number_float()) return value.dump();
    std::ostringstream text;
    text << value.get<double>();
    return text.str();
}

std::string csvOf(const std::vector<Columns>& rows) {
    std::string csv;
    const auto addLine = [&](const Columns& row, auto&& cell) {
        CsvLine line;
        for (const auto& [name, value] : row.items()) line.field(cell(name, value));
        csv += line.end();
    };
    if (rows.empty()) return csv;
    addLine(rows.front(), [](const std::string& name, const Columns&) { return name; });
    for (const Columns& row : rows)
        addLine(row, [](const std::string&, const Columns& value) { return cellOf(value); });
    return csv;
}

}  // namespace

std::vector<bool> paretoFront(std::span<const ParetoPoint> points) {
    std::vector<bool> front;
    for (const ParetoPoint& point : points) {
        bool is_best = point.is_candidate;
        for (const ParetoPoint& other : points) is_best &= !(other.is_candidate && isBetter(other, point));
        front.push_back(is_best);
    }
    return front;
}

std::optional<size_t> bestWithin(std::span<const ParetoPoint> points, double budget) {
    double least = INFINITY;
    for (const ParetoPoint& point : points)
        if (point.is_candidate && point.time <= budget) least = std::min(least, point.error);
    return fastestBelow(points, least * (1 + kSameError), budget);
}

std::optional<size_t> nextBetter(std::span<const ParetoPoint> points, size_t from) {
    return fastestBelow(points, points[from].error * (1 - kSameError), INFINITY);
}

TruthSummary summaryOf(const std::vector<ProbingStroke>& strokes, const std::vector<Truth>& truth) {
    TruthSummary summary;
    summary.refinement = kMaxRefinement;
    summary.closed_energy = INFINITY;
    NoiseSum noise;
    ErrorSum coarser;
    double force = 0, torque = 0;
    size_t count = 0;
    for (size_t n = 0; n < truth.size(); ++n) {
        summary.strokes.push_back(strokes[n].name);
        summary.refinement = std::min(summary.refinement, truth[n].refinement);
        summary.max_penetration = std::max(summary.max_penetration, truth[n].max_penetration);
        summary.closed_energy =
            std::min(summary.closed_energy, energyOf(truth[n].answers, strokes[n].device).at_end);
        noise.add(truth[n].answers);
        coarser.add(truth[n].coarser, truth[n].answers);
        for (const TickAnswer& answer : truth[n].answers) {
            const double f = answer.hand_W.force.norm(), t = answer.hand_W.torque.norm();
            if (f < Errors::kFeltForce) continue;
            force += f * f, torque += t * t, ++count;
            summary.force_max = std::max(summary.force_max, f);
            summary.torque_max = std::max(summary.torque_max, t);
        }
    }
    summary.noise = noise.noise();
    summary.coarser = coarser.errors();
    if (count)
        summary.force_rms = std::sqrt(force / double(count)),
        summary.torque_rms = std::sqrt(torque / double(count));
    return summary;
}

bool isOtherLaw(const SettingFigures& figures) noexcept {
    return figures.settings.law != ContactLaw::kGradient;
}

std::vector<ParetoPoint> paretoPoints(const std::vector<SettingFigures>& settings) {
    std::vector<ParetoPoint> points;
    for (const SettingFigures& f : settings)
        points.push_back({f.errors.force_vector, f.times.p99_9, !isOtherLaw(f)});
    return points;
}

size_t indexInForce(const ReportData& data) noexcept {
    const auto it =
        std::find_if(data.settings.begin(), data.settings.end(), [](const auto& f) { return f.is_in_force; });
    return size_t(it - data.settings.begin());
}

std::string accuracyCsv(const ReportData& data) {
    std::vector<Columns> rows;
    for (size_t n = 0; n < data.settings.size(); ++n) {
        Columns row = {{"number", n + 1}, {"setting", data.settings[n].name}};
        row.update(figuresOf(data.settings[n], data.front[n]));
        rows.push_back(std::move(row));
    }
    return csvOf(rows);
}

std::string patchCsv(const ReportData& data) {
    std::vector<Columns> rows;
    for (const PatchErrors& p : data.patches)
        rows.push_back({{"shell_factor", p.shell_factor},
                        {"tool_distance", p.tool_distance == ToolDistance::kGrid ? "grid" : "analytic"},
                        {"sdf_refinement", p.sdf_refinement},
                        {"sample_spacing_um", kPerMicrometre * p.sample_spacing},
                        {"patch_width_voxels", p.width_voxels},
                        {"depth_um", kPerMicrometre * p.depth},
                        {"force_error_rms_percent", 100 * p.force_rms},
                        {"force_error_worst_percent", 100 * p.force_worst},
                        {"direction_error_rms_deg", p.direction_rms / kDegree}});
    return csvOf(rows);
}

std::string accuracyJson(const ReportData& data) {
    Columns settings = Columns::object();
    for (size_t n = 0; n < data.settings.size(); ++n)
        settings[data.settings[n].name] = figuresOf(data.settings[n], data.front[n]);
    const Columns truth = {{"voxel_refinement", data.truth.refinement},
                           {"force_rms_n", data.truth.force_rms},
                           {"force_max_n", data.truth.force_max},
                           {"torque_rms_nmm", kPerMilli * data.truth.torque_rms},
                           {"torque_max_nmm", kPerMilli * data.truth.torque_max},
                           {"max_penetration_um", kPerMicrometre * data.truth.max_penetration},
                           {"noise_mn", kPerMilli * data.truth.noise},
                           {"half_refinement_force_error_percent", 100 * data.truth.coarser.force_vector},
                           {"closed_path_energy_uj", kPerMicro * data.truth.closed_energy}};
    const size_t in_force = indexInForce(data);
    Columns report = {{"scene", data.scene},
                      {"scene_file", data.scene_file},
                      {"machine", data.machine},
                      {"voxel_mm", kPerMillimetre * data.spacing},
                      {"contact_width_voxels", data.contact_width / data.spacing},
                      {"tick_period_us", kPerMicrosecond * data.tick_period},
                      {"processor_taken_percent", 100 * data.taken_share}};
    report["in_force"] = data.settings[in_force].name;
    if (data.budget_us) {
        report["budget_us"] = *data.budget_us;
        const auto best = bestWithin(paretoPoints(data.settings), *data.budget_us);
        report["proposal"] = best ? Columns(data.settings[*best].name) : Columns();
    }
    report["truth"] = truth;
    report["settings"] = settings;
    return report.dump(2) + '\n';
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
    WholeFile whole(file);
    std::ofstream stream(whole.part());
    stream << text;
    stream.close();
    if (!stream) throw UserError(file.string() + " cannot be written (" + std::strerror(errno) + ")");
    whole.finish();
}

}  // namespace bonemill

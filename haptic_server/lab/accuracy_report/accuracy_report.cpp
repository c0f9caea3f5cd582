#include "haptic_server/lab/accuracy_report/accuracy_report.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <ostream>
#include <set>
#include <thread>

#include "common/base/user_error.h"
#include "common/config/scene_tools.h"
#include "common/process/gnuplot.h"
#include "haptic_server/lab/accuracy_report/report_files.h"
#include "haptic_server/lab/accuracy_report/sweep.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {
namespace {

constexpr int kMaxThreads = 4;

using SteadyClock = std::chrono::steady_clock;

double secondsSince(SteadyClock::time_point start) {
    return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

// Finds out whether the files can be written before minutes of work are spent.
void makeFolder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw UserError("--out " + folder.string() + ": cannot be made (" + error.message() + ")");
    writeTextFile(folder / "report.md", "accuracy-report has not measured anything yet\n");
}

std::string machineName() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
    return "unknown processor";
}

std::vector<int> refinementsOf(const std::vector<AccuracySettings>& settings) {
    std::set<int> refinements{2, 4};
    for (const AccuracySettings& s : settings)
        if (s.sdf_refinement > 1) refinements.insert(s.sdf_refinement);
    return {refinements.begin(), refinements.end()};
}

std::vector<int> shellFactorsOf(const std::vector<AccuracySettings>& settings) {
    std::set<int> factors;
    for (const AccuracySettings& s : settings) factors.insert(s.shell_factor);
    return {factors.begin(), factors.end()};
}

double secondsLeft(SteadyClock::time_point start, size_t done, size_t count) {
    return secondsSince(start) / double(done) * double(count - done);
}

TruthProgress truthProgress(size_t count, std::ostream& out) {
    return [count, &out, start = SteadyClock::now()](size_t done) {
        char text[64];
        std::snprintf(text, sizeof text, "truth: %zu of %zu strokes; about %.0f s left, then the settings",
                      done, count, secondsLeft(start, done, count));
        out << text << std::endl;
    };
}

// Keeps what there is at any time.
class SoFar {
  public:
    SoFar(const std::filesystem::path& folder, size_t count) : folder_(folder), count_(count) {}
    void add(const SettingFigures& figures) {
        data_.settings.push_back(figures);
        data_.front = paretoFront(paretoPoints(data_.settings));
        writeTextFile(folder_ / "accuracy.csv", accuracyCsv(data_));
        writeTextFile(folder_ / "report.md", unfinishedText(data_.settings.size(), count_));
    }

  private:
    std::filesystem::path folder_;
    size_t count_;
    ReportData data_;
};

// How much of the time since it was made this thread did not have the processor, 0 .. 1.
class TakenShare {
  public:
    double now() const { return std::max(0.0, 1 - (processorSeconds() - used_) / secondsSince(start_)); }

  private:
    static double processorSeconds() {
        timespec used{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
        return double(used.tv_sec) + 1e-9 * double(used.tv_nsec);
    }
    SteadyClock::time_point start_ = SteadyClock::now();
    double used_ = processorSeconds();
};

SweepProgress progressOf(size_t count, std::ostream& out, SoFar& so_far) {
    return [count, &out, &so_far, start = SteadyClock::now()](const SettingFigures& f, size_t done) {
        so_far.add(f);
        const double left = secondsLeft(start, done, count);
        char text[256];
        std::snprintf(text, sizeof text,
                      "[%2zu/%zu] %s: force error %.3g %%, p99.9 %.3g us; about %.0f s left", done, count,
                      f.name.c_str(), 100 * f.errors.force_vector, f.times.p99_9, left);
        out << text << std::endl;
    };
}

// Measures everything; the files that need all of it come later.
ReportData measureAll(const LoadedScene& loaded, SceneSetup& simulation, const AccuracyReportOptions& options,
                      std::ostream& progress) {
    const auto settings =
        settingsNamed(options.settings,
                      sweepSettings(simulation.accuracy, simulation.tools.front().built.model.hasShapes()),
                      simulation.accuracy);
    const ToolConfig tool_config = toolConfigOf(loaded, *toolsOf(loaded.scene).front());
    const BuiltTool tool = buildTool(tool_config, refinementsOf(settings));
    FixedTickConfig tick = simulation.fixedTick();
    tick.tool.model = &tool.model;
    // The truth is the wrench at the tool, whatever the hand gets of its torque.
    tick.hand.max_torque = tick.hand_space.torqueAtTool(tick.hand.max_torque);
    tick.hand_space = {};

    // With the finest level only, paths and truth are laid out.
    BoneModel bone(VoxelVolume(simulation.bone->volume), simulation.bone->lattice.leafCells(),
                   ShellConfig{.spare_points = 1});
    TouchProbe probe(bone, tool.model);
    const auto places =
        findProbingPlaces(loaded.scene.simulated_operator(), bone, tick.tool.burr.radius, probe);
    if (places.empty())
        throw UserError(loaded.file.string() +
                        ": the tool touches no bone, neither on the way of simulated_operator nor "
                        "from the volume's faces; is volume.iso_value right?");
    std::vector<ProbingStroke> strokes;
    for (const ProbingPlace& place : places) strokes.push_back(makeStroke(place, {}, tick, probe));
    PosePath milling;
    const std::optional<TimeRemovalConfig>& removal = tick.effects.time_removal;
    if (removal && removal->rate > 0) milling = millingPath(places.front(), tick);

    progress << "truth along " << strokes.size() << " strokes" << std::endl;
    const int threads = std::clamp(int(std::thread::hardware_concurrency()), 1, kMaxThreads);
    const auto truth =
        computeTruth(strokes, tick, bone, probe, threads, truthProgress(strokes.size(), progress));

    AnalyticProbe plane({.tick = tick,
                         .spacing = bone.volume.spacing().minCoeff(),
                         .sdf_spacing = tool.model.grid().spacing(),
                         .refinements = refinementsOf(settings),
                         .shell_factors = shellFactorsOf(settings),
                         .has_analytic_tool = tool.model.hasShapes()});
    const SweepInput input{loaded.scene, bone.volume, bone.lattice.leafCells(), tick.tool, strokes, truth,
                           milling,      plane};
    ReportData data;
    SoFar so_far(options.out, settings.size());
    const TakenShare taken;
    data.settings = sweep(input, settings, progressOf(settings.size(), progress, so_far));
    data.taken_share = taken.now();
    progress << "how large a contact must be" << std::endl;
    data.front = paretoFront(paretoPoints(data.settings));
    data.truth = summaryOf(strokes, truth);
    data.patches = plane.patchErrors();
    data.scene = loaded.scene.name();
    data.scene_file = loaded.file.string();
    data.machine = machineName();
    data.spacing = bone.volume.spacing().minCoeff();
    data.burr_radius = tick.tool.burr.radius;
    data.tick_period = tick.dt;
    data.contact_width =
        contactWidth(tick.gradient.contact.stiffness_per_area, tick.tool.burr.radius, data.truth.force_rms);
    return data;
}

}  // namespace

std::string accuracyReport(const AccuracyReportOptions& options, std::ostream& progress) {
    const auto start = SteadyClock::now();
    const LoadedScene loaded = loadScene(options.scene);
    const std::filesystem::path out(options.out);
    makeFolder(out);
    progress << "reading the scene's volume" << std::endl;
    SceneSetup simulation = setUpScene(loaded);
    for (const std::string& warning : simulation.warnings) progress << "warning: " << warning << '\n';
    ReportData data = measureAll(loaded, simulation, options, progress);
    data.budget_us = options.budget_us;
    writeTextFile(out / "accuracy.csv", accuracyCsv(data));
    writeTextFile(out / "patch.csv", patchCsv(data));
    writeTextFile(out / "accuracy.json", accuracyJson(data));
    writeTextFile(out / "report.md", reportText(data));
    writeTextFile(out / "pareto.gnuplot", paretoScript(data, "pareto.png"));
    progress << "measured in " << int(secondsSince(start)) << " s" << std::endl;
    runGnuplot(out / "pareto.gnuplot");
    std::string summary;
    for (const std::string& line : reportConclusions(data)) summary += line + '\n';
    return summary + "report: " + (out / "report.md").string() + '\n';
}

}  // namespace bonemill

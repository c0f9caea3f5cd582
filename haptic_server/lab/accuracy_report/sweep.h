// Chooses the accuracy settings that the report compares, runs each along the same paths and measures it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "haptic_server/core/accuracy/accuracy_settings.h"
#include "haptic_server/lab/accuracy_report/analytic_probe.h"
#include "haptic_server/lab/accuracy_report/milling_probe.h"
#include "haptic_server/lab/accuracy_report/truth.h"
#include "haptic_server/recording/statistics/tick_times.h"
#include "proto/scene.pb.h"

namespace bonemill {

struct SettingFigures {
    AccuracySettings settings;
    std::string name;          // settingsName()
    bool is_in_force = false;  // the scene's own
    Errors errors;             // along the probing path; for other laws differences, not errors
    // errors.force_vector at the best and at the worst of the places; none without truth at any.
    std::optional<std::pair<double, double>> best_and_worst_place;
    double max_penetration = 0;  // m
    double noise = 0;            // N
    double closed_energy = 0;    // J: least that any closed stroke took from the hand
    double lowest_energy = 0;    // J: anywhere on the strokes
    PlaneErrors plane;           // burr on a plane, closed form
    struct Removal {
        double removed = 0, swept = 0, wanted = 0;  // m³, as in MillingRun
        double error() const { return swept > 0 ? removed / swept - 1 : 0; }
        double progress() const {
            return wanted > 0 ? removed / wanted : 0;
        }  // small: the burr does not get in
    };
    std::optional<Removal> removal;  // none where the scene does not mill
    TickTimes times;                 // of all ticks
    TickTimes probing_times, milling_times;
    TickTimes longest_times;  // of all ticks, the longest of the passes
    size_t ticks = 0;
    uint32_t faults = 0;  // TickFault bits
};

struct SweepInput {
    const scene::Scene& scene;
    const VoxelVolume& volume;  // the scanned bone
    Eigen::Vector3i leaf_cells;
    const SpoTool& tool;  // its model with the refined grids that the settings ask for
    const std::vector<ProbingStroke>& strokes;
    const std::vector<Truth>& truth;  // of the strokes
    const PosePath& milling;          // empty: the scene does not mill
    AnalyticProbe& plane;
};

// The figures come in the order of `settings`. Calls progress(figures, done) after each; the order of those
// calls may differ.
using SweepProgress = std::function<void(const SettingFigures& figures, size_t done)>;
std::vector<SettingFigures> sweep(const SweepInput& input, const std::vector<AccuracySettings>& settings,
                                  const SweepProgress& progress);

// These are the presets, one knob at a time around balanced and thesis_2012, the cheapest there is, and the
// scene's own. Without `has_shapes` there are only grids. No two are equal.
std::vector<AccuracySettings> sweepSettings(const AccuracySettings& of_scene, bool has_shapes);

// These are those of `all` with one of the names (capitals do not matter), and `of_scene`; all, if there is
// no name. Throws UserError where nothing has a name.
std::vector<AccuracySettings> settingsNamed(const std::vector<std::string>& names,
                                            const std::vector<AccuracySettings>& all,
                                            const AccuracySettings& of_scene);

// This is the scene with every knob of its accuracy message at these settings; normals and switchable stay.
scene::Scene sceneWith(const scene::Scene& scene, const AccuracySettings& settings);

}  // namespace bonemill

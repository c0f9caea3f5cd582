// Makes a small report with known figures.
#pragma once

#include "haptic_server/lab/accuracy_report/report_files.h"

namespace bonemill::test {

inline SettingFigures figuresOf(const AccuracySettings& settings, double error, double p99_9_us) {
    SettingFigures f;
    f.settings = settings;
    f.name = settingsName(settings);
    f.errors.force_vector = error;
    f.errors.force = error / 2;
    f.errors.direction = 0.01;
    f.times = {p99_9_us / 4, p99_9_us / 2, p99_9_us, 2 * p99_9_us};
    f.ticks = 5000;
    return f;
}

// Here balanced is in force; the front is fast, balanced, exact.
inline ReportData smallReport() {
    ReportData data;
    data.scene = "tiny";
    data.scene_file = "tiny.textproto";
    data.machine = "a machine";
    data.spacing = 0.25e-3, data.burr_radius = 1e-3, data.tick_period = 1e-3, data.contact_width = 0.5e-3;
    data.truth.refinement = 4;
    data.truth.strokes = {"here", "there"};
    data.settings = {figuresOf(presetSettings(Preset::kThesis2012), 0.3, 10),
                     figuresOf(presetSettings(Preset::kFast), 0.1, 20),
                     figuresOf(presetSettings(Preset::kBalanced), 0.02, 50),
                     figuresOf(presetSettings(Preset::kExact), 0.01, 80)};
    data.settings[2].is_in_force = true;
    data.settings[2].removal = SettingFigures::Removal{0.9e-9, 1e-9, 1.2e-9};
    data.front = paretoFront(paretoPoints(data.settings));
    data.patches = {{.shell_factor = 1, .width_voxels = 4, .depth = 1e-4, .force_rms = 0.03}};
    return data;
}

}  // namespace bonemill::test

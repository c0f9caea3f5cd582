// Holds what the report knows, and writes the files that it becomes.
#pragma once

#include <filesystem>

#include "haptic_server/lab/accuracy_report/pareto.h"
#include "haptic_server/lab/accuracy_report/sweep.h"

namespace bonemill {

// Sums up the truth along the whole probing path.
struct TruthSummary {
    int refinement = 0;  // of the voxels, the least of all strokes
    std::vector<std::string> strokes;
    double force_rms = 0, force_max = 0;    // N
    double torque_rms = 0, torque_max = 0;  // N·m
    double max_penetration = 0;             // m
    double noise = 0;                       // N
    double closed_energy = 0;               // J, least of all strokes
    Errors coarser;                         // of the same with half the refinement
};
TruthSummary summaryOf(const std::vector<ProbingStroke>& strokes, const std::vector<Truth>& truth);

struct ReportData {
    std::string scene;
    std::string scene_file;
    std::string machine;
    double spacing = 0;        // m, finest voxel spacing
    double burr_radius = 0;    // m
    double tick_period = 0;    // s
    double contact_width = 0;  // m: circle in which the burr touches a plane with the truth's force
    TruthSummary truth;
    std::vector<SettingFigures> settings;
    std::vector<bool> front;  // of settings
    std::vector<PatchErrors> patches;
    std::optional<double> budget_us;
};

bool isOtherLaw(const SettingFigures& figures) noexcept;
// Each point is a force error against p99.9; other laws are no candidates, for the truth is not that
// of its force.
std::vector<ParetoPoint> paretoPoints(const std::vector<SettingFigures>& settings);
size_t indexInForce(const ReportData& data) noexcept;

// Writes Markdown; its source is report_text.cpp.
std::string reportText(const ReportData& data);
// These are the few lines that matter: what is in force, what better costs, what fits.
std::vector<std::string> reportConclusions(const ReportData& data);

std::string accuracyCsv(const ReportData& data);
std::string patchCsv(const ReportData& data);
// It is written as readAccuracyFigures() wants it.
std::string accuracyJson(const ReportData& data);

// Throws UserError.
void writeTextFile(const std::filesystem::path& file, const std::string& text);

}  // namespace bonemill

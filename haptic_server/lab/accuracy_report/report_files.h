// Holds what the report knows, finds the settings that are worth having, and writes the files that it
// becomes.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptic_server/lab/accuracy_report/sweep.h"

namespace bonemill {

// A setting's error against its time.
struct ParetoPoint {
    double error = 0;
    double time = 0;
    bool is_candidate =
        true;  // false: its error is not one (another law); never on the front, never proposed
};

// Says of each point whether no other candidate is at least as good in both and better in one. Equal points
// are both on the front.
std::vector<bool> paretoFront(std::span<const ParetoPoint> points);

// Errors that differ by less than this part are the same for a choice.
inline constexpr double kSameError = 0.02;

// This is the most accurate candidate with time <= budget, and of those with the same error the fastest one.
std::optional<size_t> bestWithin(std::span<const ParetoPoint> points, double budget);

// This is the fastest candidate whose error is smaller than that of `from`, and not the same.
std::optional<size_t> nextBetter(std::span<const ParetoPoint> points, size_t from);

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
    double taken_share = 0;  // 0 .. 1: of the time of measuring, that other programs had the processor
};

bool isOtherLaw(const SettingFigures& figures) noexcept;
// Each point is a force error against p99.9; other laws are no candidates, for the truth is not that
// of its force.
std::vector<ParetoPoint> paretoPoints(const std::vector<SettingFigures>& settings);
size_t indexInForce(const ReportData& data) noexcept;

// Writes Markdown; its source is accuracy_report_text.cpp.
std::string reportText(const ReportData& data);
// These are the few lines that matter: what is in force, what better costs, what fits.
std::vector<std::string> reportConclusions(const ReportData& data);

std::string accuracyCsv(const ReportData& data);
// Before all is measured: what report.md says until then.
std::string unfinishedText(size_t measured, size_t of);
std::string patchCsv(const ReportData& data);
// It is written as readAccuracyFigures() wants it.
std::string accuracyJson(const ReportData& data);

// What was there stays until the new is whole. Throws UserError.
void writeTextFile(const std::filesystem::path& file, const std::string& text);

// The picture of force error against tick time: a whole gnuplot script that writes `png`, a path from where
// it runs.
std::string paretoScript(const ReportData& data, const std::filesystem::path& png);

// Labels hide neither each other nor the points.
struct PlotLabel {
    Eigen::Vector2d point;  // pixels
    std::string text;
    Eigen::Vector2d center = Eigen::Vector2d::Zero();  // pixels: where the text's middle goes
    bool needs_line = false;  // it had to go so far away that a line should lead to it
};

// Sets center and needs_line, one label after the other: the nearest free place around its point; where none
// is free, beside the point all the same.
void layOutLabels(std::vector<PlotLabel>& labels);

// This is half of the width and height of a label's text, in pixels.
Eigen::Vector2d labelHalfSize(const std::string& text);

}  // namespace bonemill

// `bonemill_lab accuracy-report` measures how exact each accuracy setting is in a scene, and how long its
// ticks take here. docs/explanation/accuracy.md says what the figures mean.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace bonemill {

struct AccuracyReportOptions {
    std::string scene;
    std::string out;                    // folder; made if it is not there
    std::optional<double> budget_us;    // propose the most accurate setting with p99.9 within it
    std::vector<std::string> settings;  // names of those to measure beside the scene's own; none: all
};

// Writes accuracy.csv, patch.csv, accuracy.json, report.md, pareto.gnuplot and pareto.png; says on `progress`
// how far it is. accuracy.csv has at any time what is measured so far, and report.md says that it is not all.
// Returns a summary for people. Throws UserError; where only the picture could not be made, the rest is
// written.
std::string accuracyReport(const AccuracyReportOptions& options, std::ostream& progress);

}  // namespace bonemill

// Makes the picture of force error against tick time, drawn by gnuplot.
#pragma once

#include "haptic_server/lab/accuracy_report/report_files.h"

namespace bonemill {

// This is a whole gnuplot script that writes `png`.
std::string paretoScript(const ReportData& data, const std::filesystem::path& png);

// Runs gnuplot on a script file as a child process. Throws UserError if there is no gnuplot or it fails.
void runGnuplot(const std::filesystem::path& script);

}  // namespace bonemill

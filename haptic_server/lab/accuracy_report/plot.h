// Makes the picture of force error against tick time, drawn by gnuplot.
#pragma once

#include "haptic_server/lab/accuracy_report/report_files.h"

namespace bonemill {

// This is a whole gnuplot script that writes `png`, a path from where it runs.
std::string paretoScript(const ReportData& data, const std::filesystem::path& png);

}  // namespace bonemill

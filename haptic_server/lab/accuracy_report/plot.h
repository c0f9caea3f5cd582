// Makes the picture of force error against tick time, drawn by gnuplot.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "haptic_server/lab/accuracy_report/report_files.h"

namespace bonemill {

// This is a whole gnuplot script that writes `png`, a path from where it runs.
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

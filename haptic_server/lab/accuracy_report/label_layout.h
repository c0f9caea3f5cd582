// Finds places for the labels of points in a plot, so that they hide neither each other nor the points.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace bonemill {

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

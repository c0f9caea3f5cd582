// Makes a smooth way past a few poses.
#pragma once

#include "haptic_server/lab/accuracy_report/timed_run.h"

namespace bonemill {

// A knot is a tool pose as an offset from a base pose, both in W.
struct PathKnot {
    Eigen::Vector3d position;                            // m, W
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  // rotation vector, W, on top of the base's rotation
};

// Makes `ticks` poses along the uniform cubic B-spline of the knots (twice continuously differentiable; it
// passes near the knots, and exactly through the first and the last one, where it rests).
PosePath smoothPath(const Eigen::Quaterniond& base, const std::vector<PathKnot>& knots, int ticks);

}  // namespace bonemill

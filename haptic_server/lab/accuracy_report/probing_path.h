// Leads the device at the probing places: smooth closed strokes with the forces of surgery.
#pragma once

#include "haptic_server/lab/accuracy_report/measures.h"
#include "haptic_server/lab/accuracy_report/probing_places.h"

namespace bonemill {

// A stroke starts and ends at rest in the same free pose: press, slide round a small closed loop on the
// surface with changing load and a few degrees of turning, let go.
struct ProbingStroke {
    std::string name;
    PosePath device;
    double deepest = 0;  // m: how far the device goes beyond the surface, about
};

// Says how hard and how long a stroke presses.
struct StrokeConfig {
    double lightest = 0.5;      // N that the coupling pulls with, about
    double heaviest = 4;        // N; less if the coupling saturates earlier
    double duration = 1.5;      // s
    double loop_radius = 1e-3;  // m, at most
    double turning = 0.05;      // rad
};

ProbingStroke makeStroke(const ProbingPlace& place, const StrokeConfig& stroke, const FixedTickConfig& tick,
                         TouchProbe& probe);

// At this distance of the device beyond the tool the gradient model's coupling pulls with `force` (less
// than its saturation).
double stretchOf(const EnergyCoupling& coupling, double force);

// A knot is a tool pose as an offset from a base pose, both in W.
struct PathKnot {
    Eigen::Vector3d position;                            // m, W
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  // rotation vector, W, on top of the base's rotation
};

// Makes `ticks` poses along the uniform cubic B-spline of the knots (twice continuously differentiable; it
// passes near the knots, and exactly through the first and the last one, where it rests).
PosePath smoothPath(const Eigen::Quaterniond& base, const std::vector<PathKnot>& knots, int ticks);

}  // namespace bonemill

#include "haptic_server/lab/accuracy_report/probing_path.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr int kLoopKnots = 24;
constexpr int kPressKnots = 3;
constexpr double kRestTime = 0.04;  // s at the end: the tool comes back to the device

// This is the loop's frame at a place.
struct Loop {
    const ProbingPlace& place;
    Vector3d t, u;
    double radius;
    double turning;

    Vector3d offset(double angle) const {
        return radius * (std::sin(angle) * t + 0.5 * (1 - std::cos(angle)) * u);
    }
    Vector3d rotation(double angle) const {
        return turning * (std::sin(angle) * t + std::sin(2 * angle) * u);
    }
};

// At this height over the place, along its normal, the tool touches there; it is nearly `before` if
// it does not.
double surfaceHeight(const Loop& loop, double angle, double before, TouchProbe& probe) {
    const ProbingPlace& place = loop.place;
    const Pose lifted{place.X_WT.position + place.room * place.normal_W + loop.offset(angle),
                      expRotation(loop.rotation(angle)) * place.X_WT.rotation};
    const auto way = probe.freeWay(lifted, -place.normal_W, place.room + 2 * loop.radius);
    if (!way) return before;
    // The path is no steeper than the loop is wide, for it must stay smooth.
    const double steepest = 2 * M_PI / kLoopKnots * loop.radius;
    return std::clamp(place.room - *way, before - steepest, before + steepest);
}

}  // namespace

PosePath smoothPath(const Eigen::Quaterniond& base, const std::vector<PathKnot>& knots, int ticks) {
    // End knots count three times: the spline starts and ends there.
    const int last = int(knots.size()) - 1;
    const auto knotAt = [&](int n) -> const PathKnot& { return knots[size_t(std::clamp(n - 2, 0, last))]; };
    const int segments = last + 2;
    PosePath path;
    for (int n = 0; n < ticks; ++n) {
        const double at = double(n) / std::max(1, ticks - 1) * segments;
        const int segment = std::min(int(at), segments - 1);
        const double t = at - segment, s = 1 - t;
        const double weights[] = {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                                  (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
        PathKnot knot{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
        for (int i = 0; i < 4; ++i) {
            knot.position += weights[i] * knotAt(segment + i).position;
            knot.rotation += weights[i] * knotAt(segment + i).rotation;
        }
        path.push_back({knot.position, (expRotation(knot.rotation) * base).normalized()});
    }
    return path;
}

double stretchOf(const EnergyCoupling& coupling, double force) {
    const double most = coupling.saturation_force;
    return std::atanh(force / most) * most / coupling.translation_stiffness;
}

ProbingStroke makeStroke(const ProbingPlace& place, const StrokeConfig& stroke, const FixedTickConfig& tick,
                         TouchProbe& probe) {
    const Vector3d t = tangentOf(place.normal_W);
    const Loop loop{place, t, place.normal_W.cross(t), std::min(stroke.loop_radius, tick.tool.burr.radius),
                    stroke.turning};
    const double heaviest = std::min(stroke.heaviest, kHeaviestShare * tick.tool.saturation_force);
    const double lightest = std::min(stroke.lightest, heaviest / 2);
    const auto pressed = [&](double angle, double height) -> PathKnot {
        const double load = lightest + (heaviest - lightest) * 0.5 * (1 - std::cos(3 * angle));
        const double depth = stretchOf(tick.toolCoupling(), load);
        return {place.X_WT.position + loop.offset(angle) + (height - depth) * place.normal_W,
                loop.rotation(angle)};
    };
    const PathKnot lifted{place.X_WT.position + place.room * place.normal_W};
    std::vector<PathKnot> knots{lifted};
    const PathKnot first = pressed(0, 0);
    for (int n = 1; n < kPressKnots; ++n)
        knots.push_back({lifted.position + double(n) / kPressKnots * (first.position - lifted.position)});
    double height = 0;
    for (int n = 0; n <= kLoopKnots; ++n) {
        const double angle = 2 * M_PI * n / kLoopKnots;
        height = surfaceHeight(loop, angle, height, probe);
        knots.push_back(pressed(angle, height));
    }
    const PathKnot last = knots.back();
    for (int n = kPressKnots - 1; n > 0; --n)
        knots.push_back({lifted.position + double(n) / kPressKnots * (last.position - lifted.position)});
    knots.push_back(lifted);

    ProbingStroke made{place.name,
                       smoothPath(place.X_WT.rotation, knots, int(std::lround(stroke.duration / tick.dt))),
                       stretchOf(tick.toolCoupling(), heaviest)};
    made.device.resize(made.device.size() + size_t(std::lround(kRestTime / tick.dt)), made.device.back());
    return made;
}

}  // namespace bonemill

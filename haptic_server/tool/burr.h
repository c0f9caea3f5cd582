// The part of the tool that cuts: a solid of revolution about the tool's axis (frame T: centre at the origin,
// +y to the hand), and how it is driven.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/geometry/pose.h"

namespace bonemill {

enum class BurrKind : uint8_t { kBall, kCylinder, kCone };
enum class BurrGrit : uint8_t { kFluted, kDiamond };

struct Burr {
    BurrKind kind = BurrKind::kBall;
    BurrGrit grit = BurrGrit::kFluted;
    double radius = 1e-3;   // m; a cone's is at its end towards the hand
    double length = 0;      // m, of a cylinder or cone, centred on T's origin
    double tip_radius = 0;  // m, of a cone's far end
    double friction = 0.5;  // μ_c: tangential force per normal force while it cuts
    double speed = 0;       // rad/s about T's +y, of a full pedal; negative: reversed

    // Of the farthest point from T's origin, m.
    double reach() const noexcept {
        return kind == BurrKind::kBall ? radius : std::hypot(std::max(radius, tip_radius), length / 2);
    }
    // Signed distance, m; negative inside. RT-safe.
    double signedDistance(const Eigen::Vector3d& p_T) const noexcept;
};

inline double Burr::signedDistance(const Eigen::Vector3d& p_T) const noexcept {
    if (kind == BurrKind::kBall) return p_T.norm() - radius;
    const double off_axis = std::hypot(p_T.x(), p_T.z()), half = length / 2;
    const double slope = kind == BurrKind::kCone ? (radius - tip_radius) / length : 0;
    const double middle = kind == BurrKind::kCone ? (radius + tip_radius) / 2 : radius;
    const double from_side = (off_axis - (middle + slope * p_T.y())) / std::sqrt(1 + slope * slope);
    const double from_end = std::abs(p_T.y()) - half;
    if (from_side <= 0 || from_end <= 0) return std::max(from_side, from_end);
    return std::hypot(from_side, from_end);  // beside the rim; of a cone nearly
}

}  // namespace bonemill

// The burr is the part of the tool that cuts: a solid of revolution about the tool's axis (frame T: centre at
// the origin, +y to the hand), and how it is driven.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/geometry/pose.h"

namespace bonemill {

enum class BurrKind : uint8_t { kBall, kCylinder, kCone };
enum class BurrGrit : uint8_t { kFluted, kDiamond, kDrill };

struct Burr {
    BurrKind kind = BurrKind::kBall;
    BurrGrit grit = BurrGrit::kFluted;
    double radius = 1e-3;            // m; a cone's is at its end towards the hand
    double length = 0;               // m, of a cylinder or cone, centred on T's origin
    double tip_radius = 0;           // m, of a cone's far end
    double friction = 0.5;           // μ_c: tangential per normal force of what cuts
    double rubbing_friction = 0.35;  // μ_e: of what its edges carry without cutting
    double speed = 0;                // rad/s about T's +y, of a full pedal; negative: reversed

    // The farthest point of the burr is so far from T's origin, in m.
    double reach() const noexcept {
        return kind == BurrKind::kBall ? radius
                                       : Eigen::Vector2d(std::max(radius, tip_radius), length / 2).norm();
    }
    // The signed distance is in m, negative inside. It is RT-safe.
    double signedDistance(const Eigen::Vector3d& p_T) const noexcept {
        if (kind == BurrKind::kBall) return p_T.norm() - radius;
        const double far_radius = kind == BurrKind::kCone ? tip_radius : radius, half = length / 2;
        // The burr's half-plane through its axis: off it and along it.
        const Eigen::Vector2d p(std::sqrt(p_T.x() * p_T.x() + p_T.z() * p_T.z()), p_T.y());
        const Eigen::Vector2d rim(far_radius, -half), way = Eigen::Vector2d(radius, half) - rim;
        const double share = std::clamp((p - rim).dot(way) / way.squaredNorm(), 0.0, 1.0);
        const double side = (p - rim - share * way).norm();
        const double far_end = Eigen::Vector2d(std::max(0.0, p.x() - far_radius), p.y() + half).norm();
        const double hand_end = Eigen::Vector2d(std::max(0.0, p.x() - radius), p.y() - half).norm();
        const double nearest = std::min({side, far_end, hand_end});
        const double width = far_radius + (radius - far_radius) * (p.y() + half) / length;
        return std::abs(p.y()) < half && p.x() < width ? -nearest : nearest;
    }
};

}  // namespace bonemill

// Leads from the handle to the tool and back: the tool goes `scale` times as far as the handle and turns with
// it.
//
// Seen from the hand the tool's world is smaller by the scale: the force is the same, the torque is divided
// by it, and so is the power, in translation and rotation alike. Were the torque not divided, a closed path
// of the hand could gain energy. What belongs to the device (limits, springs that it can bear, its dynamics)
// is at the hand; all that is simulated is at the tool. SI units, in any frame. Pure and RT-safe, for any
// thread.
#pragma once

#include "common/base/assert.h"
#include "common/geometry/pose.h"

namespace bonemill {

class HandSpace {
  public:
    HandSpace() noexcept = default;
    explicit HandSpace(double scale) noexcept : scale_(scale) { BONEMILL_ASSERT(scale > 0); }

    // A position, way, lever (m) or speed (m/s).
    double wayAtTool(double way) const noexcept { return scale_ * way; }
    double wayAtHand(double way) const noexcept { return way / scale_; }
    Eigen::Vector3d wayAtTool(const Eigen::Vector3d& way) const noexcept { return scale_ * way; }
    Eigen::Vector3d wayAtHand(const Eigen::Vector3d& way) const noexcept { return way / scale_; }
    Pose poseAtTool(const Pose& pose) const noexcept { return {wayAtTool(pose.position), pose.rotation}; }
    Pose poseAtHand(const Pose& pose) const noexcept { return {wayAtHand(pose.position), pose.rotation}; }

    // Force per way, speed or acceleration: a stiffness, a damping or a mass.
    double forcePerWayAtTool(double value) const noexcept { return value / scale_; }
    double forcePerWayAtHand(double value) const noexcept { return value * scale_; }

    // A torque, or torque per turn: a stiffness of rotation or its damping.
    double torqueAtTool(double value) const noexcept { return value * scale_; }
    double torqueAtHand(double value) const noexcept { return value / scale_; }
    Eigen::Vector3d torqueAtHand(const Eigen::Vector3d& torque) const noexcept { return torque / scale_; }

  private:
    double scale_ = 1;
};

}  // namespace bonemill

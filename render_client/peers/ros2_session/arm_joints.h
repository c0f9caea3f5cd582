// Where the sliders of an ARES stand, from where its handle is: by its inverse kinematics, for the device
// says its handle's pose. It is for one thread.
#pragma once

#include <optional>

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/geometry/hand_space.h"
#include "common/geometry/pose.h"
#include "proto/scene.pb.h"

namespace bonemill::ros2 {

struct ArmJoints {
    Vector6d positions;                  // m, from the low end of each stroke
    std::optional<Vector6d> velocities;  // m/s
};

class AresArm {
  public:
    // As the scene says; X_WD is where its base stands.
    AresArm(const scene::Device& device, const Pose& X_WD);

    // X_WT is where the hand holds the tool, v_WT (m/s) and w_WT (rad/s) how it moves, if that is known.
    // Nothing where no slider positions lead to that pose.
    struct Motion {
        Eigen::Vector3d v_WT, w_WT;
    };
    std::optional<ArmJoints> jointsAt(const Pose& X_WT, const std::optional<Motion>& motion) const;

  private:
    AresKinematics kinematics_;
    bool is_buildable_;
    HandSpace hand_space_;
    Pose X_DW_;
};

}  // namespace bonemill::ros2

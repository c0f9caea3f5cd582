// It is a tool state as the viewer's effects take it, bounded whatever came over the network. The frame is V,
// the units are SI.
#pragma once

#include <optional>

#include "common/geometry/pose.h"
#include "proto/topics.pb.h"

namespace bonemill {

struct EffectInput {
    std::optional<Pose> X_VT;  // the simulated tool
    double burr_radius = 0;
    bool is_pedal_down = false;
    double spin_speed = 0;                                     // rad/s about T's +y
    double burr_force = 0;                                     // N
    double cutting_power = 0;                                  // W
    double removed = 0;                                        // m³ since the input before
    Eigen::Vector3d towards_bone_V = Eigen::Vector3d::Zero();  // unit, from the force; 0: not touching
    Eigen::Vector3d up_V = Eigen::Vector3d::UnitZ();           // unit, against gravity
};

// The bounds are ±25,000 rad/s, 1000 N, 10 kW, 100 mm³ and 0.1 to 50 mm for the burr. It is for any thread
// and never throws.
EffectInput effectInputOf(const topics::ToolState& tool, const topics::SceneInfo& info);

}  // namespace bonemill

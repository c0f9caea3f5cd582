// The geometry of ARES as a scene file says it, in SI.
#pragma once

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/base/units.h"
#include "proto/scene.pb.h"

namespace bonemill {

inline AresGeometry aresGeometryOf(const scene::Device& device) {
    return {.base_radius = kMillimetre * device.base_radius_mm(),
            .platform_radius = kMillimetre * device.platform_radius_mm(),
            .base_half_angle = kDegree * device.base_half_angle_deg(),
            .platform_half_angle = kDegree * device.platform_half_angle_deg(),
            .link_length = kMillimetre * device.link_length_mm(),
            .stroke = kMillimetre * device.stroke_mm()};
}

}  // namespace bonemill

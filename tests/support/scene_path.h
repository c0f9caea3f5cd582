// The way of a scene's own hand as inputs of the tick, straight from waypoint to waypoint, as
// tests/support/scene_hashes has it.
#pragma once

#include <algorithm>
#include <vector>

#include "common/config/scene_geometry.h"
#include "haptic_server/core/tick/tick_io.h"
#include "proto/scene.pb.h"

namespace bonemill::test {

inline Pose scenePoseAt(const scene::SimulatedOperator& scenario, double t_s, uint32_t& buttons) {
    int from = 0;
    while (from + 2 < scenario.waypoint_size() && scenario.waypoint(from + 1).time_s() <= t_s) ++from;
    const auto &a = scenario.waypoint(from), &b = scenario.waypoint(from + 1);
    const double share = std::clamp((t_s - a.time_s()) / (b.time_s() - a.time_s()), 0.0, 1.0);
    const Pose X_WA = poseOf(a), X_WB = poseOf(b);
    buttons = (a.remove() ? kButtonRemove : 0u) | (a.add() ? kButtonAdd : 0u);
    return {X_WA.position + share * (X_WB.position - X_WA.position),
            X_WA.rotation.slerp(share, X_WB.rotation)};
}

inline std::vector<DeviceInput> scenePath(const scene::SimulatedOperator& scenario, double dt) {
    std::vector<DeviceInput> path;
    const double end_s = scenario.waypoint().rbegin()->time_s();
    for (double t_s = 0; t_s < end_s; t_s = double(path.size()) * dt) {
        DeviceInput input;
        input.X_WT_device = scenePoseAt(scenario, t_s, input.buttons);
        input.t_s = t_s;
        path.push_back(input);
    }
    return path;
}

}  // namespace bonemill::test

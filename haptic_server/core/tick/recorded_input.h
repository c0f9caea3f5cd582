// Copies what a tick took in, and what was decided for it, for its record. RT-safe.
#pragma once

#include "haptic_server/core/tick/tick_io.h"

namespace bonemill {

inline TickInput recordedInput(const DeviceInput& input, const TickDecisions& decisions) noexcept {
    TickInput out{};
    const Eigen::Quaterniond& q = input.X_WT_device.rotation;
    for (int axis = 0; axis < 3; ++axis) out.p_WT[axis] = input.X_WT_device.position[axis];
    out.q_WT[0] = q.w(), out.q_WT[1] = q.x(), out.q_WT[2] = q.y(), out.q_WT[3] = q.z();
    out.stale_factor = input.stale_factor;
    out.placements = input.placements;
    out.faults = input.faults;
    out.periods = input.periods;
    out.is_repeated = input.is_repeated;
    out.is_stale = input.is_stale;
    out.has_other_device = input.other_device != nullptr;
    if (input.other_device) out.other_device = *input.other_device;
    out.decisions = decisions;
    return out;
}

}  // namespace bonemill

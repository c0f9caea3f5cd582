// Leads the haptic tick along a path of device inputs, as fast as it goes: the one replay of everything that
// runs without a device. It is not RT-safe.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/tick/haptic_tick.h"
#include "haptic_server/core/tick/tick_config.h"
#include "haptic_server/core/tick/tick_io.h"

namespace bonemill {

// A hand this far from a volume is in another unit or frame, m.
inline constexpr double kFarFromBone = 1;
// How far a place (W, m) lies outside of the volume's box; 0 inside.
double distanceTo(const VoxelVolume& volume, const Eigen::Vector3d& p_W);

// Device poses become inputs, one per tick of `dt` seconds, with these buttons held all the way.
std::vector<DeviceInput> inputsOf(std::span<const Pose> path_WT, double dt, uint32_t buttons = 0);

// One input is one tick. `see` is called after each tick, outside what is timed.
void runPath(HapticTick& tick, std::span<const DeviceInput> path,
             const std::function<void(const TickRecord&)>& see);

// Returns the records of a tick of its own, so that the simulated tool starts where the path starts. With a
// pressed button it changes `bone`.
std::vector<TickRecord> runPath(const FixedTickConfig& config, BoneModel& bone,
                                std::span<const DeviceInput> path);

}  // namespace bonemill

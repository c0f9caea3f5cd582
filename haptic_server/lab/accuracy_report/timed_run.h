// Runs ticks along a path of device poses, timed so that other programs of the machine do not count. It
// is not RT-safe.
#pragma once

#include <span>
#include <vector>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/core/tick/tick_config.h"

namespace bonemill {

using PosePath = std::vector<Pose>;  // device poses X_WT, one per tick
using RunRecords = std::vector<TickRecord>;

// Does the same work kPasses times: the first run's records get the shortest time of each tick, so that what
// other programs took of the processor does not count. Nothing is milled.
RunRecords runPathTimed(const FixedTickConfig& config, BoneModel& bone, std::span<const Pose> path_WT);
inline constexpr int kPasses = 3;

// compute_ns of each tick becomes the smaller one of both runs of the same work.
void keepShorterTimes(RunRecords& records, const RunRecords& again) noexcept;

}  // namespace bonemill

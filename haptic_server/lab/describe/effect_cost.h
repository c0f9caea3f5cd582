// Measures what each effect of a scene adds to a tick on this machine: the same path with all of them and
// without each, in turn, again and again on the same bone. Not RT-safe; it takes milliseconds to minutes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/tick/tick_config.h"
#include "haptic_server/core/tick/tick_io.h"
#include "haptic_server/recording/statistics/tick_times.h"

namespace bonemill {

struct EffectCost {
    std::string name;
    TickTimes without;              // with all but this one; median of the rounds
    double p50_us = 0, p99_us = 0;  // with all, less that; median of the rounds' differences
};

struct EffectCosts {
    std::vector<EffectCost> effects;  // that config lists
    TickTimes all, none;              // with all, with no effect; medians of the rounds
    // This is the largest difference of a round between two runs with all: what is no more than
    // that says nothing.
    double noise_p50_us = 0, noise_p99_us = 0;
    size_t ticks = 0;  // of each run, that were looked at
};

// Times the ticks in contact or with a button pressed, if there are any. The bone is as it was afterwards,
// but for the order of its contact points.
EffectCosts measureEffectCosts(const FixedTickConfig& config, BoneModel& bone,
                               std::span<const DeviceInput> path, int rounds);

}  // namespace bonemill

// Runs through a whole recording once, beside its replay and as fast as it goes, and keeps what jumps in it
// need: the bone at many moments, the events that only ticks can tell, and when each voxel was removed.
//
// It has a bone of its own, on a thread of its own of low priority. Any thread may ask for what it has found.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "haptic_server/recording/rerun/replay_events.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "haptic_server/server/replay/keyframes.h"
#include "haptic_server/server/replay/removal_map.h"

namespace bonemill {

class Survey {
  public:
    // All must outlive this object. `scanned` is the simulation's bone before anything has changed it, and is
    // copied.
    Survey(const Recording& recording, const Simulation& simulation, const LoadedScene& scene,
           const Recording::Bones& bones, Keyframes& keyframes, ReplayEvents& events);

    void start();
    // Ticks up to here are known; recording.ticks() in the end.
    uint64_t known() const noexcept { return known_.load(std::memory_order_acquire); }
    const RemovalMap& removals() const noexcept { return removals_; }

  private:
    void run(const std::stop_token& stop);
    void look(const TickRecord& record, uint64_t tick);

    const Recording& recording_;
    Keyframes& keyframes_;
    ReplayEvents& events_;
    BoneModel bone_;
    Rerun rerun_;
    VoxelVolume start_;  // the bone before the first tick
    RemovalMap removals_;
    // Release by the survey, acquire by who asks: what it has found is there.
    std::atomic<uint64_t> known_{0};
    std::jthread thread_;
};

}  // namespace bonemill

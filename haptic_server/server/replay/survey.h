// Runs through a whole recording once, beside its replay and as fast as it goes, and keeps what jumps in it
// need: the bone at many moments, the events that only ticks can tell, and when each voxel was removed.
//
// It has a bone of its own, on a thread of its own of low priority. Any thread may ask for what it has found.
#pragma once

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/rerun/replay_events.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "haptic_server/server/replay/removal_map.h"

namespace bonemill {

// The bone at many moments of a recording: where a replay can begin to run ticks again. Any normal thread; it
// takes a mutex.
class Keyframes {
  public:
    // What bones share they have once. Of those that were added each second one goes whenever together they
    // have more than this in their own leaves.
    static constexpr size_t kMaxBytes = size_t(1) << 30;

    // Those of the recording, at least one, by tick. The first one stays.
    explicit Keyframes(const std::vector<Keyframe>& recorded, size_t most_bytes = kMaxBytes)
        : most_bytes_(most_bytes) {
        for (const Keyframe& keyframe : recorded) add(keyframe);
    }

    void add(Keyframe keyframe) {
        const std::lock_guard lock(mutex_);
        kept_.emplace(keyframe.tick, std::move(keyframe.bone));
        if (kept_.size() >= look_at_) thinOut();
    }

    // The last one that is not behind this tick, or the first one.
    Keyframe before(uint64_t tick) const {
        const std::lock_guard lock(mutex_);
        auto after = kept_.upper_bound(tick);
        if (after != kept_.begin()) --after;
        return {after->first, after->second};
    }
    size_t size() const {
        const std::lock_guard lock(mutex_);
        return kept_.size();
    }

  private:
    static constexpr size_t kLookEvery = 64;

    size_t bytes() const {
        std::vector<const LeafCopy*> leaves;
        for (const auto& [tick, bone] : kept_)
            if (bone)
                for (const auto& leaf : bone->leaves) leaves.push_back(leaf.get());
        std::ranges::sort(leaves);
        leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
        size_t bytes = 0;
        for (const LeafCopy* leaf : leaves) bytes += leaf->densities.size() * sizeof(Density);
        return bytes;
    }
    void thinOut() {
        look_at_ = kept_.size() + kLookEvery;
        if (bytes() <= most_bytes_) return;
        bool goes = true;
        std::erase_if(kept_, [&](const auto&) { return goes = !goes; });
        look_at_ = kept_.size() + kLookEvery;
    }

    size_t most_bytes_;
    mutable std::mutex mutex_;
    std::map<uint64_t, std::shared_ptr<const BoneSnapshot>> kept_;
    size_t look_at_ = kLookEvery;
};

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

// The bone at many moments of a recording: where a replay can begin to run ticks again. Any normal thread; it
// takes a mutex.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "haptic_server/recording/rerun/recording.h"

namespace bonemill {

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

}  // namespace bonemill

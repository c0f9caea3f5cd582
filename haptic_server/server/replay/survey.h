// Runs through a whole recording once, beside its replay and as fast as it goes, and keeps what jumps in it
// need: the bone at many moments, the events that only ticks can tell, and when each voxel was removed.
//
// It has a bone of its own, on a thread of its own of low priority. Any thread may ask for what it has found.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/voxel_volume.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/rerun/replay_events.h"
#include "haptic_server/recording/rerun/rerun.h"

namespace bonemill {

// Knows at which tick of a recording each voxel was removed: it looks at what the ticks have changed, one
// after the other. Voxels count as removed below the iso-value, as in TickRecord::removed_voxels.
//
// One thread adds; any may ask meanwhile. It takes a mutex, and memory for the leaves that were milled.
class RemovalMap {
  public:
    // The bone as it is before the first tick, and the one that ticks change; both must outlive the map.
    RemovalMap(const VoxelVolume& start, const VoxelVolume& bone)
        : start_(start),
          bone_(bone),
          blocks_((bone.dims().array() + kBlock - 1) / kBlock),
          map_(size_t(blocks_.cast<int64_t>().prod())) {}

    // The tick of this number has changed voxels in this box only (ends included). One that was put back, or
    // added, may be removed once more.
    void add(uint64_t tick, const IndexBox& changed) {
        if (changed.isEmpty()) return;
        const std::lock_guard lock(mutex_);
        const IndexBox all = allOf(bone_);
        forEachIndex(changed.clamped(all.min, all.max), [&](const Eigen::Vector3i& voxel) {
            Block& block = open(voxel / kBlock);
            const size_t place = placeIn(voxel);
            const bool was_bone = block.is_bone[place], is_bone = isBone(bone_, voxel);
            if (was_bone == is_bone) return;
            block.is_bone[place] = is_bone;
            if (is_bone) return;
            const auto number = uint32_t(std::min<uint64_t>(tick + 1, std::numeric_limits<uint32_t>::max()));
            if (block.first[place] == 0)
                block.first[place] = number;
            else
                again_.emplace(keyOf(voxel), number);
        });
    }
    // The bone was put back to what it was at some moment: what is bone now is looked up.
    void lookAnew() {
        const std::lock_guard lock(mutex_);
        forEachIndex({Eigen::Vector3i::Zero(), blocks_.array() - 1}, [&](const Eigen::Vector3i& block) {
            if (const auto& opened = map_[indexOf(block)]) look(bone_, block, *opened);
        });
    }

    struct Removal {
        uint64_t tick;
        Eigen::Vector3i voxel;
    };
    // Returns the removal nearest to the place (V, m) within `radius` (m): of voxels that were removed at
    // tick `now` if there is any, as of the bone that is seen then, else of all.
    std::optional<Removal> nearest(const Eigen::Vector3d& place_V, double radius, uint64_t now) const {
        const Eigen::Vector3d low = (place_V.array() - radius) / bone_.spacing().array(),
                              high = (place_V.array() + radius) / bone_.spacing().array();
        const IndexBox all = allOf(bone_);
        const IndexBox box = IndexBox{low.array().max(-1e6).min(1e6).ceil().cast<int>(),
                                      high.array().max(-1e6).min(1e6).floor().cast<int>()}
                                 .clamped(all.min, all.max);
        std::optional<Removal> seen, any;
        double seen_distance = radius, any_distance = radius;
        const std::lock_guard lock(mutex_);
        forEachIndex(box, [&](const Eigen::Vector3i& voxel) {
            const auto tick = removalOf(voxel, now);
            if (!tick) return;
            const double distance = (bone_.spacing().cwiseProduct(voxel.cast<double>()) - place_V).norm();
            std::optional<Removal>& best = *tick <= now ? seen : any;
            double& best_distance = *tick <= now ? seen_distance : any_distance;
            if (distance > best_distance) return;
            best_distance = distance;
            best = Removal{*tick, voxel};
        });
        return seen ? seen : any;
    }

  private:
    static constexpr int kAxes = 3;
    static IndexBox allOf(const VoxelVolume& volume) {
        return {Eigen::Vector3i::Zero(), volume.dims().array() - 1};
    }
    static bool isBone(const VoxelVolume& volume, const Eigen::Vector3i& voxel) {
        return volume.at(voxel.x(), voxel.y(), voxel.z()) >= volume.iso();
    }
    static constexpr int kBlock = 16;  // voxels per axis
    static constexpr size_t kVoxels = size_t(kBlock) * kBlock * kBlock;
    // Of each voxel 1 + the tick that removed it first (0: none), and whether it is bone now.
    struct Block {
        std::vector<uint32_t> first;
        std::vector<bool> is_bone;
    };
    size_t indexOf(const Eigen::Vector3i& block) const {
        return size_t(block.x()) +
               size_t(blocks_.x()) * (size_t(block.y()) + size_t(blocks_.y()) * size_t(block.z()));
    }
    static size_t placeIn(const Eigen::Vector3i& voxel) {
        size_t place = 0;
        for (int axis = kAxes - 1; axis >= 0; --axis) place = place * kBlock + size_t(voxel[axis] % kBlock);
        return place;
    }
    // Nothing in it has changed before.
    Block& open(const Eigen::Vector3i& block) {
        std::unique_ptr<Block>& opened = map_[indexOf(block)];
        if (opened) return *opened;
        opened = std::make_unique<Block>();
        opened->first.resize(kVoxels);
        opened->is_bone.resize(kVoxels);
        look(start_, block, *opened);
        return *opened;
    }
    void look(const VoxelVolume& volume, const Eigen::Vector3i& block, Block& out) const {
        const Eigen::Vector3i first = block * kBlock;
        const IndexBox voxels{first, first.array() + kBlock - 1}, all = allOf(volume);
        forEachIndex(voxels.clamped(all.min, all.max), [&](const Eigen::Vector3i& voxel) {
            out.is_bone[placeIn(voxel)] = isBone(volume, voxel);
        });
    }
    // The newest removal not after `now`, or the first one of all.
    std::optional<uint64_t> removalOf(const Eigen::Vector3i& voxel, uint64_t now) const {
        const auto& block = map_[indexOf(voxel / kBlock)];
        const uint32_t first = block ? block->first[placeIn(voxel)] : 0;
        if (first == 0) return std::nullopt;
        uint64_t newest = first - 1;
        const auto [begin, end] = again_.equal_range(keyOf(voxel));
        for (auto later = begin; later != end; ++later)
            if (const uint64_t at = later->second - 1; at <= now) newest = std::max(newest, at);
        return newest;
    }
    size_t keyOf(const Eigen::Vector3i& voxel) const {
        return indexOf(voxel / kBlock) * kVoxels + placeIn(voxel);
    }

    const VoxelVolume& start_;
    const VoxelVolume& bone_;
    Eigen::Vector3i blocks_;  // per axis
    mutable std::mutex mutex_;
    std::vector<std::unique_ptr<Block>> map_;
    std::unordered_multimap<size_t, uint32_t> again_;  // later removals, by voxel
};

// The bone at many moments of a recording: where a replay can begin to run ticks again. Any normal thread; it
// takes a mutex.
class Keyframes {
  public:
    // So far apart whoever runs ticks leaves new ones, s: as many ticks take a fraction of a second.
    static constexpr double kEveryS = 1;
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

    // Whoever has run ticks of these leaves the bone here, now and then, where there is none near before it.
    void leave(Rerun& rerun, const BoneModel& bone, double rate_hz) {
        const uint64_t next = rerun.next();
        if (next % kLookEveryTicks != 0 || rerun.history().isRestoring()) return;
        if (before(next).tick + uint64_t(std::ceil(kEveryS * rate_hz)) <= next)
            add({next, rerun.history().snapshot(bone)});
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
    static constexpr size_t kLookEvery = 64;         // keyframes, for how much they take
    static constexpr uint64_t kLookEveryTicks = 64;  // for whether one is due

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
    Survey(const Recording& recording, const SceneSetup& simulation, const LoadedScene& scene,
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

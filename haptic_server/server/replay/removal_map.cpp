#include "haptic_server/server/replay/removal_map.h"

#include <algorithm>
#include <limits>

namespace bonemill {
namespace {

constexpr int kAxes = 3;

IndexBox allOf(const VoxelVolume& volume) {
    return {Eigen::Vector3i::Zero(), volume.dims().array() - 1};
}

bool isBone(const VoxelVolume& volume, const Eigen::Vector3i& voxel) {
    return volume.at(voxel.x(), voxel.y(), voxel.z()) >= volume.iso();
}

}  // namespace

RemovalMap::RemovalMap(const VoxelVolume& start, const VoxelVolume& bone)
    : start_(start),
      bone_(bone),
      blocks_((bone.dims().array() + kBlock - 1) / kBlock),
      map_(size_t(blocks_.cast<int64_t>().prod())) {}

size_t RemovalMap::indexOf(const Eigen::Vector3i& block) const {
    return size_t(block.x()) +
           size_t(blocks_.x()) * (size_t(block.y()) + size_t(blocks_.y()) * size_t(block.z()));
}

size_t RemovalMap::placeIn(const Eigen::Vector3i& voxel) {
    size_t place = 0;
    for (int axis = kAxes - 1; axis >= 0; --axis) place = place * kBlock + size_t(voxel[axis] % kBlock);
    return place;
}

size_t RemovalMap::keyOf(const Eigen::Vector3i& voxel) const {
    return indexOf(voxel / kBlock) * kVoxels + placeIn(voxel);
}

// Nothing in it has changed before.
RemovalMap::Block& RemovalMap::open(const Eigen::Vector3i& block) {
    std::unique_ptr<Block>& opened = map_[indexOf(block)];
    if (opened) return *opened;
    opened = std::make_unique<Block>();
    opened->first.resize(kVoxels);
    opened->is_bone.resize(kVoxels);
    look(start_, block, *opened);
    return *opened;
}

void RemovalMap::look(const VoxelVolume& volume, const Eigen::Vector3i& block, Block& out) const {
    const Eigen::Vector3i first = block * kBlock;
    const IndexBox voxels{first, first.array() + kBlock - 1}, all = allOf(volume);
    forEachIndex(voxels.clamped(all.min, all.max),
                 [&](const Eigen::Vector3i& voxel) { out.is_bone[placeIn(voxel)] = isBone(volume, voxel); });
}

void RemovalMap::add(uint64_t tick, const IndexBox& changed) {
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

void RemovalMap::lookAnew() {
    const std::lock_guard lock(mutex_);
    forEachIndex({Eigen::Vector3i::Zero(), blocks_.array() - 1}, [&](const Eigen::Vector3i& block) {
        if (const auto& opened = map_[indexOf(block)]) look(bone_, block, *opened);
    });
}

std::optional<uint64_t> RemovalMap::removalOf(const Eigen::Vector3i& voxel, uint64_t now) const {
    const auto& block = map_[indexOf(voxel / kBlock)];
    const uint32_t first = block ? block->first[placeIn(voxel)] : 0;
    if (first == 0) return std::nullopt;
    uint64_t newest = first - 1;
    const auto [begin, end] = again_.equal_range(keyOf(voxel));
    for (auto later = begin; later != end; ++later)
        if (const uint64_t at = later->second - 1; at <= now) newest = std::max(newest, at);
    return newest;
}

std::optional<RemovalMap::Removal> RemovalMap::nearest(const Eigen::Vector3d& place_V, double radius,
                                                       uint64_t now) const {
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

}  // namespace bonemill

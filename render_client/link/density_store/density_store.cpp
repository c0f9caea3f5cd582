#include "render_client/link/density_store/density_store.h"

#include <algorithm>

#include "common/base/assert.h"

namespace bonemill {

Eigen::Vector3i bricksPerAxis(const DensityGrid& grid) {
    return (grid.voxels.array() + (grid.brick_edge - 1)) / grid.brick_edge;
}

int brickCount(const DensityGrid& grid) {
    return bricksPerAxis(grid).prod();
}

uint32_t brickOf(const DensityGrid& grid, const Eigen::Vector3i& voxel) {
    BONEMILL_ASSERT((voxel.array() >= 0).all() && (voxel.array() < grid.voxels.array()).all());
    const Eigen::Vector3i n = bricksPerAxis(grid), at = voxel / grid.brick_edge;
    return uint32_t(at.x() + n.x() * (at.y() + n.y() * at.z()));
}

Eigen::Vector3i firstVoxelOf(const DensityGrid& grid, uint32_t brick) {
    const Eigen::Vector3i n = bricksPerAxis(grid);
    const int b = int(brick);
    BONEMILL_ASSERT(b >= 0 && b < n.prod());
    return Eigen::Vector3i(b % n.x(), b / n.x() % n.y(), b / n.x() / n.y()) * grid.brick_edge;
}

size_t brickVoxels(const DensityGrid& grid) {
    return size_t(grid.brick_edge) * size_t(grid.brick_edge) * size_t(grid.brick_edge);
}

void DensityStore::setGrid(const DensityGrid& grid) {
    if (grid_ == grid) return;
    clear();
    grid_ = grid;
}

void DensityStore::clear() {
    if (grid_ || !bricks_.empty()) ++changes_;
    grid_.reset();
    wanted_.clear();
    bricks_.clear();
    recent_.clear();
    bytes_ = 0;
}

void DensityStore::want(std::vector<uint32_t> bricks) {
    const uint32_t count = grid_ ? uint32_t(brickCount(*grid_)) : 0;
    std::erase_if(bricks, [&](uint32_t brick) { return brick >= count; });
    if (bricks == wanted_) return;
    wanted_ = std::move(bricks);
    for (auto brick = wanted_.rbegin(); brick != wanted_.rend(); ++brick) {
        const auto held = bricks_.find(*brick);
        if (held != bricks_.end()) recent_.splice(recent_.begin(), recent_, held->second.place);
    }
}

void DensityStore::put(uint32_t brick, DensityBrick contents) {
    BONEMILL_ASSERT(grid_ && brick < uint32_t(brickCount(*grid_)));
    BONEMILL_ASSERT(contents.scanned.size() == brickVoxels(*grid_));
    BONEMILL_ASSERT(contents.present.empty() || contents.present.size() == contents.scanned.size());
    BONEMILL_ASSERT(contents.materials.empty() || contents.materials.size() == contents.scanned.size());
    ++changes_;
    bytes_ += bytesOf(contents);
    if (const auto held = bricks_.find(brick); held != bricks_.end()) {
        bytes_ -= bytesOf(held->second.contents);
        held->second.contents = std::move(contents);
    } else {
        const bool is_wanted = std::find(wanted_.begin(), wanted_.end(), brick) != wanted_.end();
        const auto place = recent_.insert(is_wanted ? recent_.begin() : recent_.end(), brick);
        bricks_.emplace(brick, Held{std::move(contents), place});
    }
    while (bytes_ > most_bytes_) dropOldest();
}

void DensityStore::dropOldest() {
    const auto held = bricks_.find(recent_.back());
    bytes_ -= bytesOf(held->second.contents);
    bricks_.erase(held);
    recent_.pop_back();
    ++changes_;
}

const DensityBrick* DensityStore::find(uint32_t brick) const {
    const auto held = bricks_.find(brick);
    return held == bricks_.end() ? nullptr : &held->second.contents;
}

bool DensityStore::hasAllWanted() const {
    return std::ranges::all_of(wanted_, [this](uint32_t brick) { return find(brick) != nullptr; });
}

}  // namespace bonemill

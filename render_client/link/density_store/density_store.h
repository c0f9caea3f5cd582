// It has the scan's densities as far as a viewer wanted to see them and they arrived, brick by brick, and
// says which bricks the viewer shows now. It is for one thread.
//
// It holds a bound of bytes at most: the brick that was not wanted for longest goes first, and comes again
// when it is wanted again.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <list>
#include <optional>
#include <unordered_map>
#include <vector>

namespace bonemill {

// The grid of the scan's voxels, cut into bricks of equal edge. It is for any thread.
//
// Voxel (i, j, k) lies at origin_m + spacing_m ∘ (i, j, k) in the volume frame V (docs/reference/frames.md).
// Bricks are numbered x fastest; the last ones of an axis may reach beyond the grid.
struct DensityGrid {
    Eigen::Vector3i voxels;     // per axis, at least 1
    Eigen::Vector3d spacing_m;  // > 0
    Eigen::Vector3d origin_m;   // of voxel (0, 0, 0), in V
    int brick_edge;             // voxels, at least 1
    double value_at_0;          // of the scan at density 0, HU where it is CT
    double value_at_65535;      // of the scan at density 65535
    double iso_value;           // of the bone surface, as the two above
    bool operator==(const DensityGrid&) const = default;
};

Eigen::Vector3i bricksPerAxis(const DensityGrid& grid);
int brickCount(const DensityGrid& grid);
// The voxel must be one of the grid.
uint32_t brickOf(const DensityGrid& grid, const Eigen::Vector3i& voxel);
// Returns the brick's first voxel. The brick must be one of the grid.
Eigen::Vector3i firstVoxelOf(const DensityGrid& grid, uint32_t brick);
// Returns how many voxels a brick holds, those beyond the grid included.
size_t brickVoxels(const DensityGrid& grid);

// A brick has brick_edge³ voxels, x fastest; those outside of the grid are 0. Densities are 0 .. 65535.
struct DensityBrick {
    std::vector<uint16_t> scanned;
    std::vector<uint16_t> present;   // empty: as scanned
    std::vector<uint8_t> materials;  // 1 + index in SceneInfo.materials, 0 for none; empty: 0 everywhere
    uint32_t revision = 0;           // of `present`: it counts up
};

class DensityStore {
  public:
    // A CT head of 512×512×140 voxels is 73 MB, 110 MB with materials, and 184 MB with all of it changed.
    static constexpr size_t kMaxBytes = size_t(256) << 20;

    explicit DensityStore(size_t most_bytes = kMaxBytes) : most_bytes_(most_bytes) {}

    // Another grid than the one before drops all bricks and wishes; the same one changes nothing.
    void setGrid(const DensityGrid& grid);
    void clear();
    const std::optional<DensityGrid>& grid() const { return grid_; }

    // These bricks are shown now, the most important first; it replaces the last wish. Numbers beyond the
    // grid are left out. It costs next to nothing when nothing changed.
    void want(std::vector<uint32_t> bricks);
    const std::vector<uint32_t>& wanted() const { return wanted_; }

    // The brick must be one of the grid, `scanned` of its size, `present` and `materials` of its size or
    // empty. It replaces what was here, and may push out bricks that were wanted less recently, or this one
    // itself.
    void put(uint32_t brick, DensityBrick contents);
    // Returns null while the brick is not here. The pointer is good until the next call that changes the
    // store.
    const DensityBrick* find(uint32_t brick) const;

    bool hasAllWanted() const;

    // It counts everything that came or went.
    uint64_t changes() const { return changes_; }
    size_t bytes() const { return bytes_; }

  private:
    struct Held {
        DensityBrick contents;
        std::list<uint32_t>::iterator place;  // in recent_
    };
    static size_t bytesOf(const DensityBrick& brick) {
        return (brick.scanned.size() + brick.present.size()) * sizeof(uint16_t) + brick.materials.size();
    }
    void dropOldest();

    size_t most_bytes_;
    std::optional<DensityGrid> grid_;
    std::vector<uint32_t> wanted_;
    std::unordered_map<uint32_t, Held> bricks_;
    std::list<uint32_t> recent_;  // of bricks_: the one wanted most recently first
    size_t bytes_ = 0;
    uint64_t changes_ = 0;
};

}  // namespace bonemill

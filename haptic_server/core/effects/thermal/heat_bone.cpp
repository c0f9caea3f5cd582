// Which cubes of the heat grid are bone, and how much of their surface is open.
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "haptic_server/core/effects/thermal/heat_grid.h"

namespace bonemill {
namespace {

constexpr int64_t kMaxBricksToRevisit = 512;

// The rows of a brick's cells (y + kEdge z) that a box in it has, and the smallest box (y, z) that holds
// some.
uint64_t rowsOf(const IndexBox& cells) noexcept {
    uint64_t rows = 0;
    for (int z = cells.min.z(); z <= cells.max.z(); ++z)
        for (int y = cells.min.y(); y <= cells.max.y(); ++y)
            rows |= uint64_t(1) << (y + DeadCells::kEdge * z);
    return rows;
}
std::pair<Eigen::Vector2i, Eigen::Vector2i> boxOf(uint64_t rows) noexcept {
    Eigen::Vector2i low = Eigen::Vector2i::Constant(DeadCells::kEdge), high = -low;
    for (; rows != 0; rows &= rows - 1) {
        const int row = std::countr_zero(rows);
        const Eigen::Vector2i at(row & (DeadCells::kEdge - 1), row >> DeadCells::kShift);
        low = low.cwiseMin(at), high = high.cwiseMax(at);
    }
    return {low, high};
}

}  // namespace

// Returns the voxel in the middle of this cube along one axis, or kOutside.
int HeatGrid::voxelAt(int cell, int axis) const noexcept {
    return size_t(cell) < voxels_[axis].size() ? voxels_[axis][size_t(cell)] : kOutside;
}

bool HeatGrid::isBone(const Eigen::Vector3i& cell) const noexcept {
    const Eigen::Vector3i voxel(voxelAt(cell.x(), 0), voxelAt(cell.y(), 1), voxelAt(cell.z(), 2));
    return voxel.minCoeff() != kOutside && bone_.at(voxel.x(), voxel.y(), voxel.z()) >= bone_.iso();
}

// Area of the cube x of a row towards the air. A surface with the unit normal n has stairs of |n_x| + |n_y| +
// |n_z| times its area.
uint8_t HeatGrid::openArea(const uint16_t* rows, int x) noexcept {
    constexpr int kCount[8] = {0, 1, 1, 2, 1, 2, 2, 3}, kToX[8] = {0, -1, 0, -1, 1, 0, 1, 0};
    const auto airOf = [&](int y, int z) { return ~unsigned(rows[y + 1 + kAround * (z + 1)]) >> x & 7; };
    const auto isAir = [&](int y, int z) { return int(airOf(y, z) >> 1 & 1); };
    const int faces = kCount[airOf(0, 0)] + isAir(-1, 0) + isAir(1, 0) + isAir(0, -1) + isAir(0, 1);
    Eigen::Vector3i outwards = Eigen::Vector3i::Zero();
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y) {
            const unsigned air = airOf(y, z);
            outwards += Eigen::Vector3i(kToX[air], y * kCount[air], z * kCount[air]);
        }
    const double length = outwards.cast<double>().norm();
    const double stairs = length > 0 ? outwards.lpNorm<1>() / length : 1;
    return uint8_t(std::lround(kPartsOfFace * faces / stairs));
}

// That of the rows that are stale.
void HeatGrid::lookUpBone(Brick& brick) noexcept {
    --lookups_;
    const BoneRows rows = rowsAround(brick);
    const bool may_have_dead = dead_.mayHave(brick.index);
    for (RowSet left = std::exchange(brick.stale, 0); left != 0; left &= left - 1) {
        const int row = std::countr_zero(left);
        const uint16_t* const around = &rows[size_t((row & (kEdge - 1)) + kAround * (row >> kShift))];
        const unsigned bone = boneIn(around), open = openIn(around);
        for (int x = 0; x < kEdge; ++x) {
            const int n = row * kEdge + x;
            const bool is_bone = bone >> x & 1;
            if (is_bone != bool(brick.is_bone[n])) brick.excess[n] = brick.hot_time[n] = 0;
            brick.is_bone[n] = is_bone;
            brick.open_area[n] = open >> x & 1 ? openArea(around, x) : uint8_t(0);
            if (!is_bone && may_have_dead) dead_.remove(brick.index, n);
        }
    }
}

// The cubes of the stale rows and those around them.
HeatGrid::BoneRows HeatGrid::rowsAround(const Brick& brick) noexcept {
    BoneRows rows{};
    int voxels[3][kAround];
    for (int axis = 0; axis < 3; ++axis)
        for (int n = 0; n < kAround; ++n) voxels[axis][n] = voxelAt(brick.index[axis] * kEdge + n - 1, axis);
    const int *const x = voxels[0], *const end = x + kAround;
    const int last = *std::max_element(x, end);
    if (last == kOutside) return rows;
    const int first = *std::find_if(x, end, [](int voxel) { return voxel != kOutside; });
    const auto [low, high] = boxOf(brick.stale);
    for (int z = low.y(); z <= high.y() + 2; ++z)
        for (int y = low.x(); y <= high.x() + 2; ++y) {
            if (voxels[2][z] == kOutside || voxels[1][y] == kOutside) continue;
            bone_.readRow({first, voxels[1][y], voxels[2][z]}, last - first + 1, row_.data());
            uint16_t& row = rows[size_t(y + kAround * z)];
            for (int n = 0; n < kAround; ++n)
                row |= uint16_t((x[n] != kOutside && row_[size_t(x[n] - first)] >= bone_.iso()) << n);
        }
    return rows;
}

void HeatGrid::noteChange(const IndexBox& voxels) noexcept {
    if (voxels.isEmpty()) return;
    // A cube is what the voxel at its middle is, and its faces what the cubes beside it are.
    IndexBox changed;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<int>& middles = voxels_[axis];
        const auto begin = middles.begin(), end = middles.end();
        changed.min[axis] = int(std::lower_bound(begin, end, voxels.min[axis]) - begin);
        changed.max[axis] = int(std::upper_bound(begin, end, voxels.max[axis]) - begin) - 1;
    }
    if (changed.isEmpty()) return;
    const IndexBox cells{changed.min.array() - 1, changed.max.array() + 1};
    const IndexBox box{brickOfCell(cells.min), brickOfCell(cells.max)};
    if (box.count() > kMaxBricksToRevisit) return noteChangeEverywhere();
    forEachIndex(
        box.clamped(Eigen::Vector3i::Zero(), bricks_.array() - 1), [&](const Eigen::Vector3i& index) {
            if (Brick* brick = find(index)) {
                const Eigen::Vector3i first = index * kEdge;
                const IndexBox own{cells.min - first, cells.max - first};
                brick->stale |=
                    rowsOf(own.clamped(Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(kEdge - 1)));
            }
            dead_.noteChange(index);
        });
}

void HeatGrid::noteChangeEverywhere() noexcept {
    for (const uint32_t slot : active_) pool_[slot].stale = kAllRows;
    dead_.noteChangeEverywhere();
}

}  // namespace bonemill

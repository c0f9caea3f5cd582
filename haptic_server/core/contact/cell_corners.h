// These are the densities at the corners of one cell, and between them. They are RT-safe.
//
// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1) in cell steps; see marching_cubes_table.h.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

// It is the density minus the iso-value at the corners, in counts, and >= 0 inside the bone. These are whole
// numbers, so it is exact.
struct CellCorners {
    std::array<float, 8> excess;

    int inside() const noexcept {  // bit by corner
        int result = 0;
        for (int corner = 0; corner < 8; ++corner) result |= int(excess[size_t(corner)] >= 0) << corner;
        return result;
    }
    float largest() const noexcept {  // absolute value
        float result = 0;
        for (const float e : excess) result = std::max(result, std::abs(e));
        return result;
    }
};

// It is the density minus the iso-value by trilinear interpolation, and its derivative per cell step.
struct FieldSample {
    float excess;
    Eigen::Vector3f slope;
};

// `cell` is in -1 .. dims-1. Plain reads: for the owner of the volume (tick thread).
inline CellCorners readCorners(const VoxelVolume& volume, const Eigen::Vector3i& cell) noexcept {
    const Density* d = volume.ownerData() + volume.offset(cell.x(), cell.y(), cell.z());
    constexpr size_t kY = VoxelVolume::kStrideY, kZ = VoxelVolume::kStrideZ;
    const int iso = volume.iso();
    return {{float(d[0] - iso), float(d[1] - iso), float(d[kY] - iso), float(d[kY + 1] - iso),
             float(d[kZ] - iso), float(d[kZ + 1] - iso), float(d[kZ + kY] - iso),
             float(d[kZ + kY + 1] - iso)}};
}

// Samples the field at `t`, in cell steps from corner 0.
inline FieldSample sampleField(const CellCorners& corners, const Eigen::Vector3f& t) noexcept {
    const auto& e = corners.excess;
    const float dx[4] = {e[1] - e[0], e[3] - e[2], e[5] - e[4], e[7] - e[6]};
    const float on_x[4] = {e[0] + t.x() * dx[0], e[2] + t.x() * dx[1], e[4] + t.x() * dx[2],
                           e[6] + t.x() * dx[3]};
    const float dy[2] = {on_x[1] - on_x[0], on_x[3] - on_x[2]};
    const float on_xy[2] = {on_x[0] + t.y() * dy[0], on_x[2] + t.y() * dy[1]};
    const float dz = on_xy[1] - on_xy[0];
    const float dx_low = dx[0] + t.y() * (dx[1] - dx[0]);
    const float dx_high = dx[2] + t.y() * (dx[3] - dx[2]);
    return {on_xy[0] + t.z() * dz,
            {dx_low + t.z() * (dx_high - dx_low), dy[0] + t.z() * (dy[1] - dy[0]), dz}};
}

}  // namespace bonemill

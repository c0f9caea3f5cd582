// Says where a voxel lies in the memory of the bone's bricks (volume/voxel_volume.h), which the volume and
// the kernels have in common.
//
// A brick has 16³ cells: the cube of cells between voxel u = 16 b and u = 16 b + 16 on each axis, u =
// index + 1 being counted from the border of air. It holds all voxels that the points and triangles in its
// cells depend on, the corners of the cells and one voxel more on each side: 19³, of which its neighbours
// have copies.
#pragma once

#include <cstddef>

namespace bonemill {

inline constexpr int kBrickShift = 4;
inline constexpr int kBrickCells = 1 << kBrickShift;
inline constexpr int kBrickLow = 1;   // voxels below the first cell's low corner
inline constexpr int kBrickHigh = 2;  // voxels above the last cell's low corner
inline constexpr int kBrickEdge = kBrickLow + kBrickCells + kBrickHigh;
inline constexpr size_t kBrickStrideY = kBrickEdge;
inline constexpr size_t kBrickStrideZ = size_t(kBrickEdge) * kBrickEdge;
inline constexpr size_t kBrickSize = kBrickStrideZ * kBrickEdge;  // voxels

}  // namespace bonemill

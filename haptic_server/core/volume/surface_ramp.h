// How densities fall across a surface that is known, so that their iso-surface is this surface.
#pragma once

#include <algorithm>

namespace bonemill {

// The density falls linearly from full to 0 while the signed distance goes from -kRampVoxels to +kRampVoxels
// voxels (of the largest spacing): wide enough that no corner of a cell with a piece of the surface is
// clamped.
inline constexpr double kRampVoxels = 2.0;

// The share of the full density, 0 .. 1, that is half at the surface; the distance is negative inside.
inline double rampShare(double distance, double voxel) noexcept {
    return std::clamp(0.5 - distance / (2 * kRampVoxels * voxel), 0.0, 1.0);
}

}  // namespace bonemill

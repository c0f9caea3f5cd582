// Turns raw values into the bone's densities: window and iso-value; and clears what is no bone and not near
// any, for it need not be kept.
//
// It is not RT-safe (it allocates) and has no shared state.
#pragma once

#include <functional>
#include <optional>

#include "haptic_server/core/volume/voxel_volume.h"
#include "haptic_server/scans/find_bone/propose_iso.h"

namespace bonemill {

// The scene asks for these raw values (HU for CT).
struct DensityWindow {
    std::optional<double> low;   // becomes density 0; absent: lowest finite value of the data
    std::optional<double> high;  // becomes density 255; absent: highest finite value
    std::optional<double> iso;   // bone surface; absent: RawVolume::surface_value, or proposeIso()
};

// These were used in the end.
struct DensityMapping {
    double low = 0;
    double high = 1;
    double iso_value = 0;
    std::optional<IsoProposal> proposed = {};  // iso_value comes from there
    Density iso = 0;                           // density of iso_value, 0 < iso < kMaxDensity

    // It is linear, clamped to 0 .. kMaxDensity and rounded to nearest; NaN becomes 0 (air).
    Density density(double raw) const noexcept;
    double raw(double density_counts) const noexcept {
        return low + (high - low) * density_counts / kMaxDensity;
    }
};

// Throws UserError when the window is empty, the iso-value lies outside it or at its edge, or no
// value is finite.
DensityMapping chooseMapping(const RawVolume& raw, const DensityWindow& window);

// Of all densities what clearFarFromBone(is_kept) leaves, without memory for what it clears.
VoxelVolume densifyNearBone(const RawVolume& raw, const DensityMapping& mapping,
                            const std::function<bool(size_t)>& is_kept = {});
// Gives the raw values' memory back as their densities come: both are never there as a whole.
VoxelVolume densifyNearBone(RawVolume&& raw, const DensityMapping& mapping,
                            const std::function<bool(size_t)>& is_kept = {});

// Does is(brick) hold for this brick or one of its neighbours?
template <class Is>
bool anyBrickAround(const BrickStore& bricks, const Eigen::Vector3i& brick, Is&& is) {
    const IndexBox all = bricks.allBricks();
    bool is_any = false;
    forEachIndex(IndexBox{brick, brick}.grown(1).clamped(all.min, all.max), [&](const Eigen::Vector3i& b) {
        is_any = is_any || is(bricks.brickAt(b.x(), b.y(), b.z()));
    });
    return is_any;
}

// Does the brick own a voxel that is_kept(index, x fastest)? Without is_kept it does not.
bool ownsAny(const VoxelVolume& volume, const Eigen::Vector3i& brick,
             const std::function<bool(size_t)>& is_kept);

// Densities in bricks that hold no bone, and whose neighbours hold none, become air: soft tissue and noise at
// least 16 voxels away from all bone, which no surface and no gradient ever sees. A burr that adds bone there
// starts from air. Their memory is given back. Bricks with a voxel that is_kept(index, x fastest) stay as
// they are; by default there is none.
void clearFarFromBone(VoxelVolume& volume, const std::function<bool(size_t)>& is_kept = {});

}  // namespace bonemill

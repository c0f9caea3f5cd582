// The densities of all voxels, however far from bone: what no program needs, but tests compare with.
#pragma once

#include "haptic_server/scans/densify/densify.h"

namespace bonemill {

inline VoxelVolume densify(const RawVolume& raw, const DensityMapping& mapping) {
    return densifyNearBone(raw, mapping, [](size_t) { return true; });
}
inline VoxelVolume densify(const RawVolume& raw, const DensityWindow& window) {
    return densify(raw, chooseMapping(raw, window));
}

}  // namespace bonemill

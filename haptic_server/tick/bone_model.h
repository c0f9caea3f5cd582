// The bone and all that is derived from it in the tick. Only the tick thread changes it; the mesher reads
// voxels.
#pragma once

#include "haptic_server/contact/point_shell.h"

namespace bonemill {

struct BoneModel {
    // leaf_cells per axis as LeafLattice; scaling_factor as PointShell. Allocates.
    BoneModel(VoxelVolume bone, const Eigen::Vector3i& leaf_cells, int scaling_factor)
        : volume(std::move(bone)), lattice(volume, leaf_cells), shell(volume, lattice, scaling_factor) {}

    VoxelVolume volume;
    LeafLattice lattice;
    PointShell shell;
};

}  // namespace bonemill

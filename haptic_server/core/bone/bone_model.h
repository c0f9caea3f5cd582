// This is the bone with all that is derived from it in the tick. Only the tick thread changes it; the mesher
// reads voxels.
#pragma once

#include "haptic_server/core/contact/point_shell.h"

namespace bonemill {

struct BoneModel {
    // How many bricks milling can open in a session: 34 million voxels, 34 cm³ at 0.1 mm, in 110 MB.
    static constexpr size_t kMaxSpareBricks = 8192;

    // leaf_cells is per axis, as for LeafLattice. It allocates.
    BoneModel(VoxelVolume bone, const Eigen::Vector3i& leaf_cells, const ShellConfig& shell_config)
        : volume(std::move(bone)), lattice(volume, leaf_cells), shell(volume, lattice, shell_config) {
        volume.makeSpareBricks(std::min(kMaxSpareBricks, volume.bricks().sharedCount()));
    }

    VoxelVolume volume;
    LeafLattice lattice;
    PointShell shell;
};

}  // namespace bonemill

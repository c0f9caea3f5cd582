// Removes what floats beside the bone: noise, pieces of the headrest.
#pragma once

#include <cstdint>

#include "haptic_server/volume/voxel_volume.h"

namespace bonemill {

struct PieceCount {
    uint64_t pieces_kept = 0;
    uint64_t pieces_removed = 0;
    uint64_t voxels_removed = 0;
};

// Connected pieces (6 neighbours: voxels that share a face) of density >= iso with fewer than
// `smallest_piece_voxels` voxels go to iso - 1, just below the surface, so that nothing of them is felt or
// drawn. Start-up only: not RT-safe, allocates 16 bytes per run of such voxels along x.
PieceCount removeSmallPieces(VoxelVolume& volume, uint32_t smallest_piece_voxels);

}  // namespace bonemill

// Drops the pieces of bone that the scene does not want: head holder, cables, noise. It is for start-up only.
#pragma once

#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "haptic_server/scans/find_bone/bone_pieces.h"

namespace bonemill {

// Does the scene say anything of pieces?
bool choosesPieces(const scene::Scene& scene);

// How the pieces that go are told of.
struct DroppedVoxels {
    BonePieces::See see = {};  // gets each voxel that goes
    int scan_voxels = 1;       // voxels of the scan per voxel of the volume, per axis
};
// By smallest_piece_voxels, keep_pieces and drop_piece; `region` is empty without a volume.region. The remark
// lists the largest pieces that were kept and that were dropped, with number, size and place. Throws
// UserError if none would be left, or a number is of no piece.
void dropPieces(const LoadedScene& loaded, VoxelVolume& volume, const IndexBox& region,
                std::vector<std::string>& remarks, const DroppedVoxels& of_dropped = {});

// Lists the largest pieces, one line each, with the numbers that volume.drop_piece takes.
std::string listPieces(const VoxelVolume& volume);

}  // namespace bonemill

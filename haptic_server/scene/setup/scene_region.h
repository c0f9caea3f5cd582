// The part of the scan that is milled: gives what the scene names (volume.region) voxels that suit its burrs,
// and drops the pieces of bone that it does not want: head holder, cables, noise. It is for start-up only.
#pragma once

#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/surroundings.h"
#include "haptic_server/scans/densify/densify.h"
#include "haptic_server/scans/densify/region.h"
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

// The voxels of the scan that the scene's bone comes from; empty: its region lies elsewhere.
IndexBox usedVoxels(const LoadedScene& loaded, const VolumeGeometry& scan);

// Says it if walls of the scan, within the region if there is one, are too thin to become bone.
void remarkThinWalls(const LoadedScene& loaded, const RawVolume& scan, double iso_value,
                     std::vector<std::string>& remarks);

// The scan without the pieces that the scene drops, cut in two. Needs a scene with a volume.region.
struct CutScan {
    RawVolume region;     // resampled
    LayersAround beyond;  // RegionRim::kLayers
    VoxelVolume whole;    // with the scan's own voxels
    Pose X_VS;            // Surroundings
    Eigen::AlignedBox3d bone;
};
// What was done, and why so finely, is added to the remarks. Throws UserError.
CutScan cutRegion(const LoadedScene& loaded, RawVolume scan, const DensityMapping& mapping,
                  std::vector<std::string>& remarks);

// Of a scan this large the pieces are those of coarser voxels where there is a region, with numbers of their
// own.
bool hasCoarsePieces(const VolumeGeometry& scan);

// Resampling leaves specks beside pieces that were dropped: what is smaller than a few of the scan's voxels
// goes.
void removeSpecks(VoxelVolume& region, const VolumeGeometry& scan);

}  // namespace bonemill

#include "haptic_server/scene/setup/scene_metal.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr double kEndOfBoneHu = 3071, kStretched = 1.5;
constexpr double kSlack = 1e-6;  // voxels

bool meet(const IndexBox& a, const IndexBox& b) {
    return ((a.min.array() <= b.max.array()) && (b.min.array() <= a.max.array())).all();
}

// What the streaks of a piece may spoil: they lie in its slices.
IndexBox reachOf(const MetalPiece& piece, const Streaks& streaks, const Eigen::Vector3d& spacing) {
    IndexBox box = piece.box;
    for (int axis = 0; axis < 2; ++axis) {
        const int steps = int(std::ceil(streaks.reach / spacing[axis]));
        box.min[axis] -= steps;
        box.max[axis] += steps;
    }
    return box;
}

bool isSpoilt(const Metal& metal, const IndexBox& used, const Eigen::Vector3d& spacing) {
    if (!metal.streaks || metal.streaks->reach == 0) return false;
    return std::ranges::any_of(metal.pieces, [&](const MetalPiece& piece) {
        return meet(reachOf(piece, *metal.streaks, spacing), used);
    });
}

}  // namespace

void remarkMetal(const LoadedScene& loaded, const Metal& metal, const VolumeGeometry& scan,
                 const VoxelVolume& bone, const IndexBox& used, std::vector<std::string>& remarks,
                 std::vector<std::string>& warnings) {
    if (metal.pieces.empty()) return;
    remarks.push_back(textOf(metal, scan));
    const scene::Volume& volume = loaded.scene.volume();
    const auto isMilled = [&](const MetalPiece& piece) {
        const Eigen::Array3d place =
            piece.first.cast<double>().array() * scan.spacing.array() / bone.spacing().array();
        const Eigen::Vector3i v = (place + kSlack).cast<int>().min(bone.dims().array() - 1).matrix();
        return meet(piece.box, used) && bone.at(v.x(), v.y(), v.z()) >= bone.iso();
    };
    if (std::ranges::any_of(metal.pieces, isMilled))
        warnings.push_back(
            std::string("metal would be milled as if it were bone; ") +
            (volume.has_region() ? "choose another volume.region" : "choose a volume.region without it") +
            ", or leave it out (volume.drop_piece) where it is a piece of its own");
    if (isSpoilt(metal, used, scan.spacing))
        warnings.push_back(
            "streaks of metal cross what is milled: they make bone of tissue and gaps in bone; choose a "
            "volume.region in other slices, or further from it");
    if (!volume.has_window_high() && metal.highest > kStretched * kEndOfBoneHu)
        warnings.push_back("metal stretches the scale of densities to " + std::to_string(int(metal.highest)) +
                           " HU; volume.window_high: " + std::to_string(int(kEndOfBoneHu + metal.water)) +
                           " ends it above all bone");
}

}  // namespace bonemill

// Where in the scan the case lies: found from the scan's voxels and what the teacher asks for.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/casework/case_request.h"
#include "haptic_server/volume/import/bone_pieces.h"
#include "haptic_server/volume/import/densify.h"
#include "haptic_server/volume/import/metal.h"

namespace bonemill {

struct CasePlan {
    DensityMapping mapping;
    std::optional<Eigen::AlignedBox3d> region;            // W, m; none: all of the bone
    uint32_t smallest_piece_voxels = 0;                   // of the scan: less is noise
    Eigen::Vector3d outwards = Eigen::Vector3d::UnitZ();  // W: from the bone to the hand
    Eigen::Vector3d start = Eigen::Vector3d::Zero();      // W, m: on the bone, where the hand begins
    Metal metal;                                          // of the scan
    std::shared_ptr<const BonePieces> pieces;             // of the scan
    std::vector<bool> is_dropped;                         // each of them: asked for, or noise
    std::vector<std::string> remarks;                     // for people
};

// The hand comes straight onto the bone at the region's middle, from `from_mm` or from the side that looks
// away from the middle of all bone. Start-up only. Throws UserError where there is no bone.
CasePlan planCase(const RawVolume& scan, const CaseRequest& request);

}  // namespace bonemill

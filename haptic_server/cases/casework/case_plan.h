// Where in the scan the case lies: found from the scan's voxels and what the teacher asks for.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/cases/casework/case_request.h"
#include "haptic_server/scans/densify/densify.h"
#include "haptic_server/scans/find_bone/bone_pieces.h"
#include "haptic_server/scans/find_bone/metal.h"

namespace bonemill {

// A piece of bone that is no noise.
struct CasePiece {
    double volume = 0;                                 // m^3
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // W, m
    bool is_dropped = false;
};

// What is found in a scan at an iso-value.
struct CaseFacts {
    DensityMapping mapping = {};
    uint32_t smallest_piece_voxels = 0;  // less is noise
    Metal metal = {};
    std::shared_ptr<const BonePieces> all_pieces = {};
    std::vector<bool> is_dropped = {};      // each of them: asked for, or noise
    std::vector<std::string> remarks = {};  // for people
};

struct CaseBone : CaseFacts {
    VoxelVolume volume;                                // without noise and pieces that are left out
    std::vector<CasePiece> pieces = {};                // the largest first; --drop-piece counts from 1
    size_t noise_pieces = 0;                           // smaller than those
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // W, m: of the largest piece that is kept
};

struct CasePlan : CaseFacts {
    std::optional<Eigen::AlignedBox3d> region = {};       // W, m; none: all of the bone
    Eigen::Vector3d outwards = Eigen::Vector3d::UnitZ();  // W: from the bone to the hand
    Eigen::Vector3d start = Eigen::Vector3d::Zero();      // W, m: on the bone, where the hand begins
    // m: of a burr for voxels that are too coarse for the default one. Where a part is milled voxels suit
    // burrs.
    std::optional<double> burr_radius = {};
};

// For people, who read it before they mill: where a case of all of the bone begins, and with which burr;
// empty: the plan has no burr of its own.
std::string burrRemark(const CasePlan& plan);

// Looks at the request's iso-value and at the pieces that it leaves out. This is the long part of the work.
// Start-up only; any thread may call it. Throws UserError where there is no bone.
CaseBone findBone(const RawVolume& scan, const CaseRequest& request);

// The hand comes straight onto the bone at the region's middle, from `from_mm` or from the side that looks
// away from the middle of all bone. Start-up only. Throws UserError where there is no bone.
CasePlan planCase(const CaseBone& bone, const CaseRequest& request);
CasePlan planCase(const RawVolume& scan, const CaseRequest& request);

}  // namespace bonemill

#include "haptic_server/cases/casework/case_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

constexpr double kNoiseShare = 1e-3;  // of the largest piece: less is noise
constexpr double kMinOutwards = 0.1;
constexpr size_t kMaxListed = 8;
constexpr double kMetalShare = 0.2;  // of a piece: the rest is its rim, which is blurred

std::optional<Eigen::Vector3d> pointOf(const std::vector<double>& mm) {
    if (mm.empty()) return std::nullopt;
    return Eigen::Vector3d(mm[0], mm[1], mm[2]) * kMillimetre;
}

std::string textOf(const Eigen::Vector3d& p_W) {
    std::ostringstream text;
    text.precision(4);
    text << "(" << (p_W * kPerMillimetre).transpose() << ") mm";
    return text.str();
}

// The bone of a scan, as seen from W.
class ScanBone {
  public:
    explicit ScanBone(const VoxelVolume& volume) : volume_(volume), X_VW_(volume.geometry().X_WV.inverse()) {}

    bool isBone(const Eigen::Vector3d& p_W) const {
        const Eigen::Vector3d v = (X_VW_ * p_W).cwiseQuotient(volume_.spacing());
        const Eigen::Vector3i voxel = v.array().round().cast<int>();
        if ((voxel.array() < 0).any() || (voxel.array() >= volume_.dims().array()).any()) return false;
        return volume_.at(voxel.x(), voxel.y(), voxel.z()) >= volume_.iso();
    }
    double reach() const { return volume_.spacing().cwiseProduct(volume_.dims().cast<double>()).norm(); }
    // The bone that lies farthest out: the hand reaches it whatever is below. There is some.
    Eigen::Vector3d outermost(const Eigen::Vector3d& outwards) const {
        const Eigen::Vector3d out_V = X_VW_.rotation * outwards;
        Eigen::Vector3d best = Eigen::Vector3d::Zero();
        double most = -std::numeric_limits<double>::infinity();
        const Eigen::Vector3i dims = volume_.dims();
        for (int k = 0; k < dims.z(); ++k)
            for (int j = 0; j < dims.y(); ++j)
                for (int i = 0; i < dims.x(); ++i) {
                    const Eigen::Vector3d p_V = volume_.spacing().cwiseProduct(Eigen::Vector3d(i, j, k));
                    if (p_V.dot(out_V) <= most || volume_.at(i, j, k) < volume_.iso()) continue;
                    most = p_V.dot(out_V);
                    best = p_V;
                }
        return volume_.geometry().X_WV * best;
    }
    // The first bone on the way from far out to the middle, within so much of it; else the middle.
    Eigen::Vector3d surface(const Eigen::Vector3d& middle, const Eigen::Vector3d& outwards,
                            double within) const {
        const double step = volume_.spacing().minCoeff() / 2;
        for (double out = within; out > -within; out -= step)
            if (isBone(middle + out * outwards)) return middle + out * outwards;
        return middle;
    }

  private:
    const VoxelVolume& volume_;
    Pose X_VW_;
};

// A quarter of the burr's radius is as fine as a part's voxels would be (docs/reference/volumes.md). The
// largest one is as large as round burrs for bone are.
std::optional<double> fittingRadius(const Eigen::Vector3d& spacing) {
    constexpr double kVoxels = 4, kStep = 0.5e-3, kDefault = 1e-3, kLargest = 8e-3;
    const double radius = std::ceil(kVoxels * std::sqrt(spacing.squaredNorm() / 3) / kStep - 1e-6) * kStep;
    return radius > kDefault ? std::optional(std::min(radius, kLargest)) : std::nullopt;
}

Eigen::Vector3d toWorld(const VolumeGeometry& geometry, const Eigen::Vector3d& voxel) {
    return geometry.X_WV * Eigen::Vector3d(voxel.cwiseProduct(geometry.spacing));
}

std::vector<CasePiece> piecesOf(const CaseBone& bone, const VolumeGeometry& geometry) {
    std::vector<CasePiece> found;
    for (const BonePiece& piece : bone.all_pieces->list())
        if (piece.voxels >= bone.smallest_piece_voxels)
            found.push_back({double(piece.voxels) * geometry.spacing.prod(), toWorld(geometry, piece.middle),
                             bone.is_dropped[found.size()]});
    return found;
}

void describePieces(const BonePieces& pieces, const VolumeGeometry& geometry, uint32_t smallest,
                    std::vector<std::string>& remarks) {
    const auto noise =
        std::ranges::count_if(pieces.list(), [&](const BonePiece& piece) { return piece.voxels < smallest; });
    const size_t count = pieces.list().size() - size_t(noise);
    for (size_t n = 0; n < std::min(count, kMaxListed); ++n)
        remarks.push_back(textOf(pieces.list()[n], n + 1, geometry));
    if (noise > 0) remarks.push_back(std::to_string(noise) + " smaller pieces are taken for noise");
    if (count > 1) remarks.push_back("--drop-piece NUMBER leaves one out: a head holder, a cable");
}

// Metal is left out where it is a piece of its own, or so much of one that no bone is lost with it.
void describeMetal(const CaseBone& bone, const VolumeGeometry& geometry, std::vector<std::string>& remarks) {
    if (bone.metal.pieces.empty()) return;
    remarks.push_back(textOf(bone.metal, geometry));
    std::vector<uint64_t> metal_of(bone.all_pieces->list().size());
    for (const MetalPiece& metal : bone.metal.pieces) {
        const std::vector<bool> is_in = bone.all_pieces->touching({metal.first, metal.first});
        const auto piece = std::ranges::find(is_in, true);
        if (piece != is_in.end()) metal_of[size_t(piece - is_in.begin())] += metal.voxels;
    }
    for (size_t n = 0; n < metal_of.size(); ++n) {
        if (metal_of[n] == 0 || bone.is_dropped[n]) continue;
        const std::string piece = "piece " + std::to_string(n + 1);
        if (double(metal_of[n]) > kMetalShare * double(bone.all_pieces->list()[n].voxels))
            remarks.push_back(piece + " is metal: --drop-piece " + std::to_string(n + 1) + " leaves it out");
        else
            remarks.push_back("metal is joined to the bone of " + piece +
                              " and would be milled as if it were bone: choose a place without it (--at)");
    }
    if (bone.metal.streaks && bone.metal.streaks->reach > 0)
        remarks.push_back(
            "streaks make bone of tissue and gaps in bone: choose a place in other slices, or further from "
            "them");
}

// Those that are asked for, and noise beside the largest of the others: this many voxels are none.
std::vector<bool> droppedOf(const BonePieces& pieces, const std::vector<uint32_t>& asked_for,
                            uint32_t& smallest) {
    std::vector<bool> is_dropped(pieces.list().size());
    for (const uint32_t piece : asked_for) {
        if (piece < 1 || piece > is_dropped.size())
            throw UserError("--drop-piece " + std::to_string(piece) + ": there are only " +
                            std::to_string(is_dropped.size()) + " pieces");
        is_dropped[piece - 1] = true;
    }
    const auto largest = size_t(std::ranges::find(is_dropped, false) - is_dropped.begin());
    if (largest == is_dropped.size()) throw UserError("--drop-piece drops all bone");
    smallest = uint32_t(kNoiseShare * double(pieces.list()[largest].voxels));
    for (size_t n = 0; n < is_dropped.size(); ++n)
        is_dropped[n] = is_dropped[n] || pieces.list()[n].voxels < smallest;
    return is_dropped;
}

}  // namespace

CaseBone findBone(const RawVolume& scan, const CaseRequest& request) {
    DensityWindow window;
    window.iso = request.iso;
    const DensityMapping mapping = chooseMapping(scan, window);
    CaseBone bone{{.mapping = mapping}, densifyNearBone(scan, mapping)};
    if (mapping.proposed) bone.remarks.push_back("iso-value " + textOf(*mapping.proposed));
    bone.all_pieces = std::make_shared<const BonePieces>(bone.volume);
    const BonePieces& pieces = *bone.all_pieces;
    if (pieces.list().empty()) throw UserError("no voxel of the scan reaches the iso-value; set --iso");
    bone.is_dropped = droppedOf(pieces, request.drop_pieces, bone.smallest_piece_voxels);
    bone.pieces = piecesOf(bone, scan.geometry);
    bone.noise_pieces = pieces.list().size() - bone.pieces.size();
    bone.metal = findMetal(scan);
    describePieces(pieces, scan.geometry, bone.smallest_piece_voxels, bone.remarks);
    describeMetal(bone, scan.geometry, bone.remarks);
    pieces.drop(bone.volume, bone.is_dropped);
    const auto largest = size_t(std::ranges::find(bone.is_dropped, false) - bone.is_dropped.begin());
    bone.middle = toWorld(scan.geometry, pieces.list()[largest].middle);
    return bone;
}

CasePlan planCase(const CaseBone& bone, const CaseRequest& request) {
    CasePlan plan{bone};
    const Eigen::Vector3d middle = pointOf(request.at_mm).value_or(bone.middle);
    const ScanBone scan(bone.volume);
    double within = scan.reach();
    if (!request.at_mm.empty()) {
        const Eigen::Vector3d half = Eigen::Vector3d::Constant(request.size_mm * kMillimetre / 2);
        plan.region = Eigen::AlignedBox3d(middle - half, middle + half);
        within = half.x();
    }
    const Eigen::Vector3d from = pointOf(request.from_mm).value_or(2 * middle - bone.middle) - middle;
    if (from.norm() > kMinOutwards * kMillimetre) plan.outwards = from.normalized();
    plan.start = scan.surface(middle, plan.outwards, within);
    if (!plan.region && !scan.isBone(plan.start)) plan.start = scan.outermost(plan.outwards);
    if (!plan.region && request.tools.empty()) plan.burr_radius = fittingRadius(bone.volume.spacing());
    if (plan.region && !scan.isBone(plan.start))
        throw UserError("there is no bone at --at " + textOf(middle) + " for a hand that comes from " +
                        textOf(middle + within * plan.outwards) + "; the bone's middle is " +
                        textOf(bone.middle));
    plan.remarks.push_back("the hand begins at " + textOf(plan.start) + " and comes from " +
                           textOf(plan.start + 0.05 * plan.outwards));
    if (plan.burr_radius) plan.remarks.push_back(burrRemark(plan));
    return plan;
}

std::string burrRemark(const CasePlan& plan) {
    if (!plan.burr_radius) return {};
    return printed(
               "All of the bone can be milled, with the scan's own coarse voxels: the case begins on its "
               "outside, with "
               "a ball of %g mm, which is as fine as they bear.",
               2 * *plan.burr_radius * kPerMillimetre) +
           " For finer work make a case of a part.";
}

CasePlan planCase(const RawVolume& scan, const CaseRequest& request) {
    return planCase(findBone(scan, request), request);
}

}  // namespace bonemill

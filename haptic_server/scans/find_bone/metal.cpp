#include "haptic_server/scans/find_bone/metal.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/base/units.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/find_bone/bone_pieces.h"
#include "haptic_server/scans/find_bone/propose_iso.h"

namespace bonemill {
namespace {

constexpr double kMaxShare = 0.05;  // of all voxels: what has more is no scan in Hounsfield units
constexpr double kMinNeighbours =
    3;  // of six that are metal, too, on average: half of them, as noise at the limit
constexpr uint64_t kMinStanding = 2;   // voxels
constexpr double kMaxAroundHu = 2200;  // mean of what a small piece touches: enamel is denser
constexpr double kMinClipped = 0.05;   // of the metal's voxels have the highest value
constexpr size_t kMostNamed = 3;

bool areTooMany(size_t metal, size_t all) {
    return double(metal) > kMaxShare * double(all);
}

// The voxels at or above a value, in the order of their indices; no further than until they are too many.
template <class Samples>
std::vector<size_t> voxelsFrom(Samples samples, size_t row, double value, double high) {
    using Sample = typename Samples::value_type;
    const auto low = Sample(value), most = Sample(high);
    std::vector<size_t> found;
    for (size_t first = 0; first < samples.size() && !areTooMany(found.size(), samples.size());
         first += row) {
        const auto of_row = samples.subspan(first, std::min(row, samples.size() - first));
        size_t count = 0;
        for (const Sample v : of_row) count += v >= low && v <= most;
        if (count == 0) continue;
        for (size_t n = 0; n < of_row.size(); ++n)
            if (of_row[n] >= low && of_row[n] <= most) found.push_back(first + n);
    }
    return found;
}

// What is connected through voxel faces, of a list of voxels in order (union-find).
class Clusters {
  public:
    Clusters(const std::vector<size_t>& voxels, const Eigen::Vector3i& dims) : parent_(voxels.size()) {
        std::iota(parent_.begin(), parent_.end(), size_t(0));
        const size_t row = size_t(dims.x()), slice = row * size_t(dims.y());
        for (const size_t step : {size_t(1), row, slice}) {
            size_t behind = 0;
            for (size_t n = 0; n < voxels.size(); ++n) {
                while (voxels[behind] + step < voxels[n]) ++behind;
                const bool is_first = step == 1     ? voxels[n] % row == 0
                                      : step == row ? voxels[n] % slice < row
                                                    : voxels[n] < slice;
                if (voxels[behind] + step == voxels[n] && !is_first) join(behind, n);
            }
        }
    }
    // The first voxel of its cluster.
    size_t firstOf(size_t n) noexcept {
        while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
        return n;
    }

  private:
    void join(size_t a, size_t b) noexcept {
        a = firstOf(a);
        b = firstOf(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    std::vector<size_t> parent_;
};

struct Candidate {
    MetalPiece piece;
    double metal_neighbours = 0, other_neighbours = 0, sum_of_others = 0;  // HU

    bool isSolid() const { return metal_neighbours >= kMinNeighbours * double(piece.voxels); }
    bool standsOut() const {
        return piece.voxels >= kMinStanding && sum_of_others < kMaxAroundHu * other_neighbours;
    }
};

// Noise that reaches so high makes more lone voxels than pieces that stand out.
bool isNoisy(const std::vector<Candidate>& candidates) {
    const auto lone =
        std::ranges::count_if(candidates, [](const Candidate& c) { return c.piece.voxels == 1; });
    const auto standing =
        std::ranges::count_if(candidates, [](const Candidate& c) { return !c.isSolid() && c.standsOut(); });
    return lone >= std::max<ptrdiff_t>(standing, 1);
}

std::vector<MetalPiece> piecesOf(const RawVolume& scan, const std::vector<size_t>& voxels, double water) {
    const Eigen::Vector3i& dims = scan.geometry.dims;
    Clusters clusters(voxels, dims);
    std::vector<Candidate> candidates;
    std::vector<size_t> candidate_of(voxels.size());
    const auto indexOf = [&](const Eigen::Vector3i& v) {
        return size_t(v.x()) + size_t(dims.x()) * (size_t(v.y()) + size_t(dims.y()) * size_t(v.z()));
    };
    for (size_t n = 0; n < voxels.size(); ++n) {
        const size_t row = voxels[n] / size_t(dims.x());
        const Eigen::Vector3i v(int(voxels[n] % size_t(dims.x())), int(row % size_t(dims.y())),
                                int(row / size_t(dims.y())));
        const size_t first = clusters.firstOf(n);
        if (first == n) candidates.emplace_back().piece.first = v;
        candidate_of[n] = first == n ? candidates.size() - 1 : candidate_of[first];
        Candidate& candidate = candidates[candidate_of[n]];
        ++candidate.piece.voxels;
        candidate.piece.box.include(v);
        candidate.piece.middle += v.cast<double>();
        for (int side = 0; side < 6; ++side) {
            Eigen::Vector3i beside = v;
            beside[side / 2] += side % 2 ? 1 : -1;
            if (beside[side / 2] < 0 || beside[side / 2] >= dims[side / 2]) continue;
            const double hu = double(scan.values[indexOf(beside)]) - water;
            if (hu >= kMetalHu)
                ++candidate.metal_neighbours;
            else if (std::isfinite(hu))
                ++candidate.other_neighbours, candidate.sum_of_others += hu;
        }
    }
    std::vector<MetalPiece> pieces;
    const bool is_noisy = isNoisy(candidates);
    for (Candidate& candidate : candidates) {
        if (!candidate.isSolid() && (is_noisy || !candidate.standsOut())) continue;
        candidate.piece.middle /= double(candidate.piece.voxels);
        pieces.push_back(candidate.piece);
    }
    std::ranges::stable_sort(pieces, std::greater{}, &MetalPiece::voxels);
    return pieces;
}

bool isClipped(const RawVolume& scan, const std::vector<size_t>& voxels) {
    const auto high = float(scan.values.range().high);
    const auto count = std::ranges::count_if(voxels, [&](size_t n) { return scan.values[n] == high; });
    return count >= 2 && double(count) >= kMinClipped * double(voxels.size());
}

std::string sizeOf(uint64_t voxels, const VolumeGeometry& geometry) {
    return volumeText(double(voxels) * geometry.spacing.prod());
}

std::string placeOf(const MetalPiece& piece, const VolumeGeometry& geometry) {
    const Eigen::Vector3d at =
        geometry.X_WV * Eigen::Vector3d(piece.middle.cwiseProduct(geometry.spacing)) * kPerMillimetre;
    return printed("(%.1f, %.1f, %.1f) mm", at.x(), at.y(), at.z());
}

// Where they lie is said along the axis of W that they are stacked along, unless they are askew.
std::string slicesOf(const Streaks& streaks, const VolumeGeometry& geometry) {
    const std::string count =
        printed("%d of %d slices", streaks.last_slice - streaks.first_slice + 1, geometry.dims.z());
    const Eigen::Vector3d across = geometry.X_WV.rotation * Eigen::Vector3d::UnitZ();
    int axis = 0;
    if (across.cwiseAbs().maxCoeff(&axis) < 0.99) return count;
    const auto at = [&](int slice) {
        const Eigen::Vector3d p_V(0, 0, slice * geometry.spacing.z());
        return (geometry.X_WV * p_V)[axis] * kPerMillimetre;
    };
    const auto [low, high] = std::minmax({at(streaks.first_slice), at(streaks.last_slice)});
    return count + printed(" (%c = %.1f .. %.1f mm)", "xyz"[axis], low, high);
}

std::string textOf(const Streaks& streaks, const VolumeGeometry& geometry) {
    const std::string than =
        printed("beside it soft tissue varies by %.0f HU, in slices without metal by %.0f", streaks.spread,
                streaks.usual_spread);
    if (streaks.reach == 0)
        return "its streaks, if there are any, are too faint to be measured (" + than + ")";
    return "its streaks spoil " + slicesOf(streaks, geometry) +
           printed(" up to %.0f mm%s from it: ", streaks.reach * kPerMillimetre,
                   streaks.goes_further ? " and more" : "") +
           than;
}

}  // namespace

Metal findMetal(const RawVolume& scan) {
    const double high = scan.values.range().high;
    if (!(high >= kMetalHu)) return {};
    const std::optional<double> water = waterValue(scan);
    if (!water || !(high >= *water + kMetalHu)) return {};
    const std::vector<size_t> voxels = scan.values.visit([&](auto samples) {
        return voxelsFrom(samples, size_t(scan.geometry.dims.x()), *water + kMetalHu, high);
    });
    if (areTooMany(voxels.size(), scan.values.size())) return {};
    Metal metal{.pieces = piecesOf(scan, voxels, *water),
                .water = *water,
                .highest = high - *water,
                .is_clipped = isClipped(scan, voxels),
                .is_scale_sure = *water == 0};
    std::vector<IndexBox> boxes;
    for (const MetalPiece& piece : metal.pieces) boxes.push_back(piece.box);
    if (!boxes.empty()) metal.streaks = measureStreaks(scan, *water, boxes);
    return metal;
}

std::string textOf(const Metal& metal, const VolumeGeometry& geometry) {
    if (metal.pieces.empty()) return {};
    uint64_t voxels = 0;
    for (const MetalPiece& piece : metal.pieces) voxels += piece.voxels;
    const size_t count = metal.pieces.size();
    std::string text = "metal: " + sizeOf(voxels, geometry) + " of 3050 HU and more";
    if (!metal.is_scale_sure) text += ", if the values are Hounsfield units";
    text += count == 1 ? ", in one piece around " : ", in " + std::to_string(count) + " pieces: ";
    for (size_t n = 0; n < std::min(count, kMostNamed); ++n) {
        if (n > 0) text += ", ";
        if (count > 1) text += sizeOf(metal.pieces[n].voxels, geometry) + " around ";
        text += placeOf(metal.pieces[n], geometry);
    }
    if (count > kMostNamed) text += " and smaller ones";
    text +=
        printed(metal.is_clipped ? "; the scanner's values end at %.0f HU" : "; the highest value is %.0f HU",
                metal.highest);
    text += "; " + (metal.streaks ? textOf(*metal.streaks, geometry)
                                  : std::string("no soft tissue around it to see streaks in"));
    return text;
}

}  // namespace bonemill

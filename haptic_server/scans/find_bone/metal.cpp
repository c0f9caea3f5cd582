#include "haptic_server/scans/find_bone/metal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/base/units.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/find_bone/bone_pieces.h"
#include "haptic_server/scans/find_bone/propose_iso.h"

namespace bonemill {
namespace {

constexpr double kSoftHu = 300;                    // tissue and fat, and what streaks make of them
constexpr double kStep = 3e-3, kGrid = 1e-3;       // m: between the two of a pair, and between pairs
constexpr double kRing = 5e-3, kFarthest = 60e-3;  // m
constexpr int kRings = int(kFarthest / kRing);
constexpr int kMaxSlices = 16, kMaxBeside = 4;
constexpr size_t kMaxBoxes = 64;                  // more take minutes
constexpr int kMinApart = 2;                      // slices: what is nearer may show some of the metal
constexpr double kMinPairs = 100;                 // in a ring
constexpr double kWorse = 1.5, kMinIndexHu = 30;  // than slices without metal: anatomy differs by less

// The differences of pairs in each ring, counted by whole HU.
class Spreads {
  public:
    void add(double distance, double difference_hu) {
        ++counts_[size_t(distance / kRing)][size_t(difference_hu)];
    }
    bool isKnown(int ring) const { return pairs(ring) >= kMinPairs; }
    // As a standard deviation, were they normal.
    double at(int ring) const {
        constexpr double kSigmaOfMedian = 1.4826;
        double below = 0;
        size_t difference = 0;
        while ((below += counts_[size_t(ring)][difference]) < pairs(ring) / 2) ++difference;
        return kSigmaOfMedian * (double(difference) + 0.5) / std::sqrt(2.0);
    }

  private:
    double pairs(int ring) const {
        double sum = 0;
        for (const uint32_t count : counts_[size_t(ring)]) sum += count;
        return sum;
    }

    std::array<std::array<uint32_t, size_t(2 * kSoftHu) + 1>, kRings> counts_{};
};

using Boxes = std::vector<IndexBox>;

// The distance within a slice.
double distanceTo(const Boxes& boxes, int i, int j, const Eigen::Vector3d& spacing) {
    double nearest = kFarthest;
    for (const IndexBox& box : boxes) {
        const double x = std::max({box.min.x() - i, i - box.max.x(), 0}) * spacing.x();
        const double y = std::max({box.min.y() - j, j - box.max.y(), 0}) * spacing.y();
        nearest = std::min(nearest, std::sqrt(x * x + y * y));
    }
    return nearest;
}

struct Slices {
    const RawVolume& scan;
    double water;

    void addTo(Spreads& spreads, const Boxes& metal, int k) const {
        scan.values.visit([&](auto samples) { addTo(spreads, samples, metal, k); });
    }

  private:
    template <class Samples>
    void addTo(Spreads& spreads, Samples samples, const Boxes& metal, int k) const {
        const Eigen::Vector3i& dims = scan.geometry.dims;
        const Eigen::Vector3d& spacing = scan.geometry.spacing;
        const auto steps = [&](double length, int axis) {
            return std::max(1, int(std::lround(length / spacing[axis])));
        };
        const int aside = steps(kStep, 0), back = steps(kStep, 1);
        const auto hu = [&](int i, int j) {
            return double(
                       samples[size_t(i) + size_t(dims.x()) * (size_t(j) + size_t(dims.y()) * size_t(k))]) -
                   water;
        };
        const auto isSoft = [](double value) { return value > -kSoftHu && value < kSoftHu; };
        for (int j = 0; j + back < dims.y(); j += steps(kGrid, 1))
            for (int i = 0; i + aside < dims.x(); i += steps(kGrid, 0)) {
                const double here = hu(i, j);
                if (!isSoft(here)) continue;
                const double distance = distanceTo(metal, i, j, spacing);
                if (distance >= kFarthest) continue;
                for (const double there : {hu(i + aside, j), hu(i, j + back)})
                    if (isSoft(there)) spreads.add(distance, std::abs(there - here));
            }
    }
};

// The slices that are joined to those of the first box by others, and the largest boxes in there.
struct Group {
    int first, last;
    Boxes boxes;

    explicit Group(std::span<const IndexBox> metal) : first(metal[0].min.z()), last(metal[0].max.z()) {
        for (bool is_growing = true; is_growing;) {
            is_growing = false;
            for (const IndexBox& box : metal) {
                if (box.min.z() > last + kMinApart || box.max.z() < first - kMinApart) continue;
                is_growing = is_growing || box.min.z() < first || box.max.z() > last;
                first = std::min(first, box.min.z());
                last = std::max(last, box.max.z());
            }
        }
        for (const IndexBox& box : metal)
            if (boxes.size() < kMaxBoxes && box.min.z() >= first && box.max.z() <= last) boxes.push_back(box);
    }
};

bool hasMetal(std::span<const IndexBox> metal, int slice) {
    return std::ranges::any_of(
        metal, [&](const IndexBox& box) { return box.min.z() <= slice && slice <= box.max.z(); });
}

// `metal` are boxes of its pieces, the largest first; the slices of that one are looked at, with those that
// join them, and distances are from the largest 64 in there. `water` is the value of 0 HU. Nothing comes
// where there is too little soft tissue around the metal, or no slice without it.
std::optional<Streaks> measureStreaks(const RawVolume& scan, double water, std::span<const IndexBox> metal) {
    const Group group(metal);
    const Slices slices{scan, water};
    std::vector<Spreads> spreads(3);  // with metal, before it, behind it
    const int count = group.last - group.first + 1, looked_at = std::min(count, kMaxSlices);
    for (int n = 0; n < looked_at; ++n)
        slices.addTo(spreads[0], group.boxes, group.first + (2 * n + 1) * count / (2 * looked_at));
    for (const int side : {-1, 1}) {
        int k = side < 0 ? group.first : group.last;
        for (int n = 0; n < kMaxBeside; ++n) {
            k += side * (n == 0 ? kMinApart : 1);
            if (k < 0 || k >= scan.geometry.dims.z() || hasMetal(metal, k)) break;
            slices.addTo(spreads[side < 0 ? 1 : 2], group.boxes, k);
        }
    }
    Streaks streaks{.first_slice = group.first, .last_slice = group.last};
    for (int ring = 0; ring < kRings; ++ring) {
        double usual = 0;
        for (const size_t side : {1u, 2u})
            if (spreads[side].isKnown(ring)) usual = std::max(usual, spreads[side].at(ring));
        if (!spreads[0].isKnown(ring) || usual == 0) {
            if (streaks.usual_spread == 0) continue;  // bone around the metal
            break;
        }
        const double spread = spreads[0].at(ring);
        if (streaks.usual_spread == 0) streaks.spread = spread, streaks.usual_spread = usual;
        if (spread < kWorse * usual || spread * spread < usual * usual + kMinIndexHu * kMinIndexHu) break;
        streaks.reach = (ring + 1) * kRing;
        streaks.goes_further = ring + 1 == kRings;
    }
    if (streaks.usual_spread == 0) return std::nullopt;
    return streaks;
}

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

#include "haptic_server/scans/find_bone/streaks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

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

}  // namespace

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

}  // namespace bonemill

#include "haptic_server/scans/densify/voxel_materials.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <utility>

#include "common/base/user_error.h"
#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/scans/densify/region.h"

namespace bonemill {
namespace {

// Each value becomes the largest of those up to `reach` places before and behind it along one axis, whose
// places are `stride` values apart; NaN counts for nothing.
template <class T>
std::vector<T> largestAlong(const std::vector<T>& values, size_t stride, size_t places, size_t reach) {
    if (reach == 0) return values;
    std::vector<T> largest = values;
    const size_t block = stride * places;
    for (size_t first = 0; first < values.size(); first += block)
        for (size_t place = 0; place < places; ++place) {
            const std::span<T> out(&largest[first + place * stride], stride);
            const size_t low = place - std::min(place, reach), high = std::min(place + reach, places - 1);
            for (size_t other = low; other <= high; ++other) {
                const T* const in = &values[first + other * stride];
                for (size_t n = 0; n < stride; ++n) out[n] = in[n] > out[n] ? in[n] : out[n];
            }
        }
    return largest;
}

template <class T>
std::vector<T> largestAround(std::vector<T> values, const Eigen::Vector3i& dims,
                             const Eigen::Array3i& reach) {
    size_t stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
        values = largestAlong(values, stride, size_t(dims[axis]), size_t(reach[axis]));
        stride *= size_t(dims[axis]);
    }
    return values;
}

// Nothing lies between the surface and the voxels of a region that is no finer than the scan.
Eigen::Array3i reachOf(const Eigen::Vector3d& scan_spacing, const Eigen::Vector3d& spacing) {
    constexpr double kFiner = 1 + 1e-6, kRounding = 1e-6;
    const Eigen::Array3d ratio = scan_spacing.array() / spacing.array();
    return (ratio > kFiner).select((ratio / 2 + kRounding).floor(), 0.0).cast<int>();
}

constexpr double kSamePlace = 0.01;  // voxels: headers round

// The eight voxels around a place.
struct LabelCorners {
    std::array<double, 8> label, share;

    double ofLargestShare() const {
        double best = label[0], best_share = -1;
        for (size_t n = 0; n < 8; ++n) {
            double all = 0;
            for (size_t m = 0; m < 8; ++m) all += label[m] == label[n] ? share[m] : 0;
            if (all < best_share || (all == best_share && label[n] < best)) continue;
            best = label[n];
            best_share = all;
        }
        return best;
    }
};

template <class Samples>
class LabelReader {
  public:
    LabelReader(Samples samples, const Eigen::Vector3i& dims) : samples_(samples), dims_(dims) {}

    bool isInside(const Eigen::Vector3d& at) const {
        return (at.array() > -0.5 - kSamePlace).all() &&
               (at.array() < dims_.cast<double>().array() - 0.5 + kSamePlace).all();
    }
    double nearest(const Eigen::Vector3i& v) const {
        const Eigen::Vector3i in = v.cwiseMax(0).cwiseMin(dims_ - Eigen::Vector3i::Ones());
        return double(samples_[size_t(in.x()) +
                               size_t(dims_.x()) * (size_t(in.y()) + size_t(dims_.y()) * size_t(in.z()))]);
    }
    LabelCorners cornersOf(const Eigen::Vector3d& at) const {
        const Eigen::Vector3i low = at.array().floor().cast<int>();
        const Eigen::Vector3d t = at - low.cast<double>();
        LabelCorners corners;
        for (int corner = 0; corner < 8; ++corner) {
            const Eigen::Vector3i bit(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
            corners.label[size_t(corner)] = nearest(low + bit);
            corners.share[size_t(corner)] =
                (bit.x() ? t.x() : 1 - t.x()) * (bit.y() ? t.y() : 1 - t.y()) * (bit.z() ? t.z() : 1 - t.z());
        }
        return corners;
    }

  private:
    Samples samples_;
    Eigen::Vector3i dims_;
};

class MaterialsOfLabels {
  public:
    explicit MaterialsOfLabels(std::span<const MaterialRule> rules) : of_label_(kMaxLabel + 1) {
        for (size_t n = 0; n < rules.size(); ++n)
            for (const uint32_t label : rules[n].labels) of_label_[label].set(n + 1);
    }

    MaterialId of(double label) const { return last(ruledBy(label)); }
    MaterialId of(const LabelCorners& corners) const {
        std::array<Ids, 8> ids;
        Ids any;
        for (size_t n = 0; n < 8; ++n) any |= ids[n] = ruledBy(corners.label[n]);
        for (MaterialId id = last(any); id != kNoMaterial; --id) {
            constexpr double kHalf = 0.5 + 1e-9;  // two structures that meet do not both have it
            double share = 0;
            for (size_t n = 0; n < 8; ++n) share += ids[n][id] ? corners.share[n] : 0;
            if (share > kHalf) return id;
        }
        return of(corners.ofLargestShare());
    }

  private:
    using Ids = std::bitset<kMaxMaterials + 1>;

    static MaterialId last(const Ids& ids) {
        if (ids.none()) return kNoMaterial;
        size_t id = kMaxMaterials;
        while (!ids[id]) --id;
        return MaterialId(id);
    }
    Ids ruledBy(double label) const {
        return label >= 0 && label <= kMaxLabel ? of_label_[size_t(label)] : Ids();
    }

    std::vector<Ids> of_label_;
};

}  // namespace

RawValues innerValues(const RawVolume& region, double iso_value, const Eigen::Vector3d& scan_spacing) {
    const VolumeGeometry& grid = region.geometry;
    const Eigen::Array3i reach = reachOf(scan_spacing, grid.spacing);
    return region.values.visit([&]<class T>(std::span<const T> samples) {
        std::vector<T> largest =
            largestAround(std::vector<T>(samples.begin(), samples.end()), grid.dims, reach);
        for (size_t n = 0; n < samples.size(); ++n)
            if (!(double(samples[n]) >= iso_value)) largest[n] = samples[n];
        RawValues inner;
        inner.append(std::move(largest));
        return inner;
    });
}

RawValues surfaceValues(const RawVolume& region, const RawValues& inner, double iso_value,
                        const Eigen::Vector3d& scan_spacing) {
    const VolumeGeometry& grid = region.geometry;
    return region.values.visit([&]<class T>(std::span<const T> samples) {
        std::vector<uint8_t> is_other(samples.size());
        for (size_t n = 0; n < samples.size(); ++n) is_other[n] = !(double(samples[n]) >= iso_value);
        is_other = largestAround(std::move(is_other), grid.dims, reachOf(scan_spacing, grid.spacing));
        std::vector<T> values(samples.begin(), samples.end());
        for (size_t n = 0; n < samples.size(); ++n)
            if (is_other[n]) values[n] = T(inner[n]);
        RawValues of_materials;
        of_materials.append(std::move(values));
        return of_materials;
    });
}

ResampledLabels resampleLabels(const RawVolume& labels, std::span<const MaterialRule> rules,
                               const VolumeGeometry& grid, const std::string& label_file) {
    if (const ValueRange& range = labels.values.range(); !range.are_integers || range.non_finite > 0)
        throw UserError(label_file +
                        " holds values that are no whole numbers: labels are needed, not a scan");
    const Eigen::Affine3d map = indexMap(grid, labels.geometry);
    const MaterialsOfLabels materials(rules);
    ResampledLabels out;
    out.is_exact = true;
    out.ids.reserve(grid.voxelCount());
    size_t covered = 0;
    labels.values.visit([&](auto samples) {
        const LabelReader reader(samples, labels.geometry.dims);
        forEachIndex({Eigen::Vector3i::Zero(), grid.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
            const Eigen::Vector3d at = map * v.cast<double>();
            const bool is_inside = reader.isInside(at);
            const Eigen::Vector3i voxel = at.array().round().cast<int>();
            const bool is_voxel = (at - voxel.cast<double>()).cwiseAbs().maxCoeff() < kSamePlace;
            covered += is_inside;
            out.is_exact = out.is_exact && is_inside && is_voxel;
            out.ids.push_back(!is_inside ? materials.of(0)
                              : is_voxel ? materials.of(reader.nearest(voxel))
                                         : materials.of(reader.cornersOf(at)));
        });
    });
    out.covered = double(covered) / double(grid.voxelCount());
    if (covered == 0) throw UserError(label_file + " lies beside the volume: none of its voxels is in there");
    return out;
}

}  // namespace bonemill

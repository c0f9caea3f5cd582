#include "haptic_server/scans/densify/distance_transform.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/base/user_error.h"

namespace bonemill {
namespace {

class FieldBuilder {
  public:
    FieldBuilder(const BoneProperties& properties, const MaterialTable& materials,
                 const Eigen::Vector3d& spacing, double reach)
        : properties_(properties), materials_(materials), spacing_(spacing) {
        const Eigen::Vector3d steps = (reach / spacing.array()).ceil();
        halo_ = steps.cast<int>() + Eigen::Vector3i::Ones();
        forEachIndex({Eigen::Vector3i::Zero(), properties.dims().array() - 1}, [&](const Eigen::Vector3i& v) {
            if (protectedAt(v) != kNoMaterial) marked_.include(v);
        });
    }
    bool isEmpty() const { return marked_.isEmpty(); }

    std::unique_ptr<DistanceField> build(double reach, int64_t voxels_at_once) {
        const IndexBox box{marked_.min - halo_, marked_.max + halo_};
        requireFew(box.count(), reach);
        auto field = std::make_unique<DistanceField>(box, spacing_, reach);
        const int layers = layersAtOnce(*field, voxels_at_once);
        for (int first = 0; first < field->layerCount(); first += layers)
            fill(*field, first, std::min(layers, field->layerCount() - first));
        return field;
    }

  private:
    // Small voxels, far seen, would need the memory of many scans.
    void requireFew(int64_t voxels, double reach) const {
        constexpr int64_t kAlwaysFew = int64_t(1) << 27, kScans = 8;
        if (voxels <= std::max(kAlwaysFew, kScans * properties_.dims().cast<int64_t>().prod())) return;
        constexpr int64_t kMillion = 1'000'000;
        throw UserError("protected structures: " + std::to_string(std::lround(reach * kPerMillimetre)) +
                        " mm around them (distance, 4 mm at least, and burr) are " +
                        std::to_string(voxels / kMillion) +
                        " million voxels; give effects.protected_structures.warning_distance_mm and "
                        "effects.virtual_fixture.distance_mm less, or take a scan with larger voxels");
    }
    MaterialId protectedAt(const Eigen::Vector3i& voxel) const {
        const MaterialId id = properties_.material(voxel);
        return materials_[id].is_protected ? id : kNoMaterial;
    }
    // Halos make the work three times as much at most.
    int layersAtOnce(const DistanceField& field, int64_t voxels_at_once) const {
        const IndexBox one = field.layer(0);
        const int64_t slice = one.count() / (one.max.z() - one.min.z() + 1);
        const int64_t slices = voxels_at_once / slice - 2 * halo_.z();
        return int(std::max<int64_t>(slices, halo_.z() + BrickMap::kEdge - 1) / BrickMap::kEdge);
    }
    void fill(DistanceField& field, int first, int count) {
        IndexBox box = field.layer(first);
        box.include(field.layer(first + count - 1));
        // What is nearer than the reach lies within the halo; nothing marked lies outside of marked_.
        IndexBox around{box.min, box.max};
        around.min.z() = std::max(box.min.z() - halo_.z(), std::min(box.min.z(), marked_.min.z()));
        around.max.z() = std::min(box.max.z() + halo_.z(), std::max(box.max.z(), marked_.max.z()));
        DistanceTransform outside(around, spacing_);
        outside.run([&](const Eigen::Vector3i& v) { return protectedAt(v); });
        DistanceTransform inside(around, spacing_);
        inside.run([&](const Eigen::Vector3i& v) {
            return MaterialId(protectedAt(v) == kNoMaterial ? 1 : kNoMaterial);
        });
        for (int layer = first; layer < first + count; ++layer)
            field.fillLayer(layer, [&](const Eigen::Vector3i& v) {
                const double out = outside.distance(v);
                return std::pair(out > 0 ? out : -inside.distance(v), outside.nearest(v));
            });
    }

    const BoneProperties& properties_;
    const MaterialTable& materials_;
    Eigen::Vector3d spacing_;
    Eigen::Vector3i halo_;
    IndexBox marked_;
};

// One parabola takes over from another at this place, in m of the line.
double crossing(double p, double f_p, double q, double f_q) {
    return (f_q + q * q - f_p - p * p) / (2 * (q - p));
}

}  // namespace

std::unique_ptr<DistanceField> protectedDistance(const BoneProperties& properties,
                                                 const MaterialTable& materials,
                                                 const Eigen::Vector3d& spacing, double reach,
                                                 int64_t voxels_at_once) {
    FieldBuilder builder(properties, materials, spacing, reach);
    if (builder.isEmpty()) return nullptr;
    return builder.build(reach, voxels_at_once);
}

DistanceTransform::DistanceTransform(const IndexBox& box, const Eigen::Vector3d& spacing)
    : box_(box), spacing_(spacing), size_(box.max - box.min + Eigen::Vector3i::Ones()) {
    const size_t count = size_t(box.count());
    squared_.resize(count);
    id_.resize(count);
    along_z_.resize(count);
    const size_t longest = size_t(size_.maxCoeff());
    line_.resize(longest);
    hull_.resize(longest);
    from_.resize(longest + 1);
}

double DistanceTransform::distance(const Eigen::Vector3i& voxel) const {
    const size_t at = indexOf(voxel);
    const double squared = squared_[at];
    if (!(squared < kNone) || squared == 0) return squared;
    // Voxels are as wide as long in almost every scan, but often higher or flatter.
    const double flat = spacing_.x() * spacing_.y(), high = spacing_.z() * spacing_.z();
    const double z = along_z_[at] * spacing_.z();
    const double upright = z * z / squared;
    return std::sqrt(squared) - 0.5 * std::sqrt(upright * high + (1 - upright) * flat);
}

void DistanceTransform::runAxis(int axis) {
    const int across = axis == 0 ? 1 : 0, other = axis == 2 ? 1 : 2;
    size_t stride = 1;
    for (int a = 0; a < axis; ++a) stride *= size_t(size_[a]);
    for (int b = 0; b < size_[other]; ++b)
        for (int a = 0; a < size_[across]; ++a) {
            Eigen::Vector3i start = box_.min;
            start[across] += a;
            start[other] += b;
            runLine(indexOf(start), stride, size_[axis], spacing_[axis], axis == 2);
        }
}

void DistanceTransform::runLine(size_t start, size_t stride, int count, double step, bool is_z) {
    int hulls = 0;
    for (int n = 0; n < count; ++n) {
        line_[size_t(n)] = {squared_[start + size_t(n) * stride], id_[start + size_t(n) * stride]};
        if (!(line_[size_t(n)].squared < kNone)) continue;
        double from = -std::numeric_limits<double>::infinity();
        while (hulls > 0) {
            const int last = hull_[size_t(hulls - 1)];
            from = crossing(last * step, line_[size_t(last)].squared, n * step, line_[size_t(n)].squared);
            if (from > from_[size_t(hulls - 1)]) break;
            --hulls;
            from = -std::numeric_limits<double>::infinity();
        }
        hull_[size_t(hulls)] = n;
        from_[size_t(hulls++)] = from;
    }
    if (hulls == 0) return;
    int hull = 0;
    for (int n = 0; n < count; ++n) {
        while (hull + 1 < hulls && from_[size_t(hull + 1)] < n * step) ++hull;
        const int at = hull_[size_t(hull)];
        const double way = (n - at) * step;
        const size_t out = start + size_t(n) * stride;
        squared_[out] = float(way * way + line_[size_t(at)].squared);
        id_[out] = line_[size_t(at)].id;
        if (is_z) along_z_[out] = int16_t(n - at);
    }
}

}  // namespace bonemill

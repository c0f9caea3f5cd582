#include "haptic_server/scans/densify/protected_distance.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "haptic_server/scans/densify/distance_transform.h"

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

}  // namespace

std::unique_ptr<DistanceField> protectedDistance(const BoneProperties& properties,
                                                 const MaterialTable& materials,
                                                 const Eigen::Vector3d& spacing, double reach,
                                                 int64_t voxels_at_once) {
    FieldBuilder builder(properties, materials, spacing, reach);
    if (builder.isEmpty()) return nullptr;
    return builder.build(reach, voxels_at_once);
}

}  // namespace bonemill

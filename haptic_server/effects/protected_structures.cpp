#include "haptic_server/effects/protected_structures.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/effects/voxel_inside.h"

namespace bonemill {
namespace {

// That a tick looks at; the burr's other rows wait for the next ones.
constexpr int64_t kMostVoxels = 4096;

// A burr without a speed is one that removes by time.
bool isCutting(const EffectTick& tick) noexcept {
    return tick.spin_speed != 0 || (tick.is_pedal_down && tick.tool->burr.speed == 0);
}

}  // namespace

ProtectedStructures::ProtectedStructures(const ProtectedStructuresConfig& config, const EffectConfigs& all,
                                         const BoneModel& bone)
    : HapticEffect(kReadsContacts),
      config_(config),
      properties_(all.properties),
      field_(all.protected_field),
      bone_(bone),
      is_damaged_(properties_->placeCount()) {
    for (size_t id = 0; id < all.materials.size(); ++id) is_protected_[id] = all.materials[id].is_protected;
}

void ProtectedStructures::finish(EffectTick& tick) noexcept {
    const NearestStructure nearest = nearestStructure(*field_, BurrProbes(tick.tool->burr), tick.X_VT);
    const double force = pressedOn(tick);
    // Near enough for voxels to be lost: the burr's limit in the bone lies a little outside of it.
    const bool is_reached = nearest.distance < bone_.volume.spacing().norm();
    const size_t newly_damaged = is_reached && isCutting(tick) ? countDamage(tick) : 0;
    damaged_ += newly_damaged;

    EffectRecord& record = tick.record;
    record.protected_id = nearest.material;
    record.protected_distance = float(nearest.distance);
    record.protected_force = float(force);
    record.damaged_volume = float(double(damaged_) * bone_.volume.voxelVolume());
    if (nearest.distance < config_.warning_distance) record.events |= kEventNearProtected;
    if (nearest.distance <= 0 || force > 0) record.events |= kEventProtectedTouched;
    if (newly_damaged > 0) record.events |= kEventProtectedDamaged;
}

double ProtectedStructures::pressedOn(const EffectTick& tick) const noexcept {
    const Eigen::Vector3f spacing = bone_.volume.spacing().cast<float>();
    const Eigen::Vector3f p_VT = tick.X_VT.position.cast<float>();
    double force = 0;
    for (const SurfaceContact& contact : tick.contacts) {
        const Eigen::Vector3i voxel = voxelInside(p_VT + contact.r_V, contact.push_V, spacing);
        if (isProtected(properties_->material(voxel))) force += double(contact.force);
    }
    return force;
}

// In the rows of voxels around the burr, from where the last tick ended.
size_t ProtectedStructures::countDamage(const EffectTick& tick) noexcept {
    const VoxelVolume& volume = bone_.volume;
    const Eigen::Array3d reach = tick.tool->burr.reach() + volume.spacing().array();
    const Eigen::Array3d dims = volume.dims().cast<double>();
    const Eigen::Array3d center = tick.X_VT.position.array();
    const Eigen::Array3d low = ((center - reach) / volume.spacing().array()).max(0.0).min(dims);
    const Eigen::Array3d high = ((center + reach) / volume.spacing().array()).max(-1.0).min(dims - 1);
    const IndexBox box{low.ceil().cast<int>().matrix(), high.floor().cast<int>().matrix()};
    if (box.isEmpty()) return 0;
    const Pose X_TV = tick.X_VT.inverse();
    const int64_t row_length = box.max.x() - box.min.x() + 1;
    const int64_t rows_in_box = box.count() / row_length;
    const int64_t rows = std::min(rows_in_box, std::max<int64_t>(1, kMostVoxels / row_length));
    Eigen::Vector2i at = next_row_;
    if ((at.array() < box.min.tail<2>().array()).any() || (at.array() > box.max.tail<2>().array()).any())
        at = box.min.tail<2>();
    size_t damaged = 0;
    for (int64_t n = 0; n < rows; ++n) {
        damaged += damageInRow(tick, X_TV, {{box.min.x(), at.x(), at.y()}, {box.max.x(), at.x(), at.y()}});
        if (++at.x() <= box.max.y()) continue;
        at.x() = box.min.y();
        if (++at.y() > box.max.z()) at.y() = box.min.z();
    }
    next_row_ = at;
    return damaged;
}

size_t ProtectedStructures::damageInRow(const EffectTick& tick, const Pose& X_TV,
                                        const IndexBox& row) noexcept {
    size_t damaged = 0;
    forEachIndex(row, [&](const Eigen::Vector3i& voxel) {
        const size_t place = properties_->placeOf(voxel);
        if (place == BrickMap::kNowhere || !isProtected(properties_->materialAt(place))) return;
        if (is_damaged_[place] || !isDestroyed(tick, X_TV, voxel, place)) return;
        is_damaged_[place] = true;
        ++damaged;
    });
    return damaged;
}

bool ProtectedStructures::isDestroyed(const EffectTick& tick, const Pose& X_TV, const Eigen::Vector3i& voxel,
                                      size_t place) const noexcept {
    const VoxelVolume& volume = bone_.volume;
    const Density iso = volume.iso();
    if (properties_->originalAt(place) >= iso && volume.at(voxel.x(), voxel.y(), voxel.z()) < iso)
        return true;
    const Eigen::Vector3d p_V = volume.spacing().cwiseProduct(voxel.cast<double>());
    return tick.tool->burr.signedDistance(X_TV * p_V) < 0;
}

}  // namespace bonemill

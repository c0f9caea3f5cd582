// Watches the burr near protected structures: how far it is, how hard the tool presses on them, how much of
// them was destroyed. Changes nothing.
//
// Damaged is a voxel of a protected material once a turning burr has covered its centre, or it has lost its
// bone. It counts once, until the scan is put back; to go back to a checkpoint undoes no damage.
#include <algorithm>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "haptic_server/core/effects/burr_probes.h"
#include "haptic_server/core/effects/effect_configs.h"
#include "haptic_server/core/effects/effect_host.h"
#include "haptic_server/core/effects/haptic_effect.h"
#include "haptic_server/core/effects/voxel_inside.h"

namespace bonemill {
namespace {

// A tick looks at so many; the burr's other rows wait for the next ones.
constexpr int64_t kMostVoxels = 4096;
constexpr int64_t kVoxelsPerFarRow = 4;  // a row without anything protected takes as long as so many

// A burr without a speed is one that removes by time.
bool isCutting(const EffectTick& tick) noexcept {
    return tick.spin_speed != 0 || (tick.is_pedal_down && tick.tool->burr.speed == 0);
}

// One bit per place, all of which are forgotten at once in a time that does not depend on their number: marks
// of a group that were made before that are wiped when the group is next written to.
//
// The constructor allocates; all else is RT-safe, for one thread.
class PlaceMarks {
  public:
    explicit PlaceMarks(size_t places) : groups_((places + kPlaces - 1) / kPlaces) {}

    bool has(size_t place) const noexcept {
        const Group& group = groups_[place / kPlaces];
        return group.round == round_ && group.marks[place % kPlaces];
    }
    void set(size_t place) noexcept {
        Group& group = groups_[place / kPlaces];
        if (group.round != round_) group = {round_, {}};
        group.marks[place % kPlaces] = true;
    }
    void forget() noexcept { ++round_; }

  private:
    static constexpr size_t kPlaces = 4096;  // of a group: 512 bytes
    struct Group {
        uint64_t round = 0;
        std::bitset<kPlaces> marks;
    };
    std::vector<Group> groups_;
    uint64_t round_ = 0;
};

class ProtectedStructures final : public HapticEffect {
  public:
    // Keeps a reference to the bone.
    ProtectedStructures(const ProtectedStructuresConfig& config, const EffectConfigs& all,
                        const BoneModel& bone)
        : HapticEffect(kReadsContacts),
          config_(config),
          properties_(all.properties),
          field_(all.protected_field),
          bone_(bone),
          is_damaged_(properties_->placeCount()) {
        for (size_t id = 0; id < all.materials.size(); ++id)
            is_protected_[id] = all.materials[id].is_protected;
    }
    void restart(Restart why) noexcept override {
        if (why != Restart::kScanPutBack) return;
        is_damaged_.forget();
        damaged_ = 0;
        is_put_back_ = true;
    }
    void finish(EffectTick& tick) noexcept override {
        const NearestStructure nearest = nearestStructure(*field_, BurrProbes(tick.tool->burr), tick.X_VT);
        const Pressed pressed = pressedOn(tick);
        const bool is_whole = !std::exchange(is_put_back_, false);
        // It is near enough for voxels to be lost: the burr's limit in the bone lies a little outside of it.
        const bool is_reached = is_whole && nearest.distance < bone_.volume.spacing().norm();
        const Destroyed destroyed =
            is_reached && (isCutting(tick) || tick.is_pedal_down) ? countDamage(tick) : Destroyed{};
        damaged_ += destroyed.voxels;

        EffectRecord& record = tick.record;
        record.protected_id = nearest.material;
        record.protected_distance = float(nearest.distance);
        record.protected_force = float(pressed.force);
        record.touched_id = pressed.force > 0       ? pressed.hardest
                            : nearest.distance <= 0 ? nearest.material
                                                    : 0u;
        record.damaged_id = destroyed.material;
        record.damaged_volume = float(double(damaged_) * bone_.volume.voxelVolume());
        if (nearest.distance < config_.warning_distance) record.events |= kEventNearProtected;
        if (record.touched_id != 0) record.events |= kEventProtectedTouched;
        if (destroyed.voxels > 0) record.events |= kEventProtectedDamaged;
    }

  private:
    bool isProtected(MaterialId id) const noexcept { return is_protected_[id]; }
    struct Pressed {
        double force = 0;                  // N
        MaterialId hardest = kNoMaterial;  // under the contact of the largest force
    };
    struct Destroyed {
        size_t voxels = 0;
        MaterialId material = kNoMaterial;  // of the last one
    };
    Pressed pressedOn(const EffectTick& tick) const noexcept {
        const Eigen::Vector3f spacing = bone_.volume.spacing().cast<float>();
        const Eigen::Vector3f p_VT = tick.X_VT.position.cast<float>();
        Pressed pressed;
        float hardest = 0;
        for (const SurfaceContact& contact : tick.contacts) {
            const Eigen::Vector3i voxel = voxelInside(p_VT + contact.r_V, contact.push_V, spacing);
            const MaterialId material = properties_->material(voxel);
            if (!isProtected(material)) continue;
            pressed.force += double(contact.force);
            if (contact.force > hardest) pressed.hardest = material;
            hardest = std::max(hardest, contact.force);
        }
        return pressed;
    }
    // Looks at the rows of voxels around the burr, from where the last tick ended.
    Destroyed countDamage(const EffectTick& tick) noexcept {
        const VoxelVolume& volume = bone_.volume;
        const Eigen::Array3d reach = tick.tool->burr.reach() + volume.spacing().array();
        const IndexBox box = boxAround(volume, BurrWay(tick.X_VT.position), reach);
        if (box.isEmpty()) return {};
        const Pose X_TV = tick.X_VT.inverse();
        const int64_t row_length = box.max.x() - box.min.x() + 1;
        int64_t rows = box.count() / row_length;
        Eigen::Vector2i at = next_row_;
        if ((at.array() < box.min.tail<2>().array()).any() || (at.array() > box.max.tail<2>().array()).any())
            at = box.min.tail<2>();
        Destroyed destroyed;
        for (int64_t left = kMostVoxels; rows > 0 && left > 0; --rows) {
            const IndexBox row{{box.min.x(), at.x(), at.y()}, {box.max.x(), at.x(), at.y()}};
            const bool is_near = mayHaveProtected(row);
            if (is_near) damageInRow(tick, X_TV, row, destroyed);
            left -= is_near ? row_length : kVoxelsPerFarRow;
            if (++at.x() <= box.max.y()) continue;
            at.x() = box.min.y();
            if (++at.y() > box.max.z()) at.y() = box.min.z();
        }
        next_row_ = at;
        return destroyed;
    }
    // The distance of the row's middle decides: it may be less than half a row, and what the distance may be
    // off.
    bool mayHaveProtected(const IndexBox& row) const noexcept {
        const Eigen::Vector3d spacing = bone_.volume.spacing();
        const Eigen::Vector3d middle = spacing.cwiseProduct((row.min + row.max).cast<double>() / 2);
        const double half = spacing.x() * (row.max.x() - row.min.x()) / 2, far = half + 2 * spacing.norm();
        return far >= field_->reach() || field_->at(middle).distance < far;
    }
    void damageInRow(const EffectTick& tick, const Pose& X_TV, const IndexBox& row,
                     Destroyed& destroyed) noexcept {
        forEachIndex(row, [&](const Eigen::Vector3i& voxel) {
            const size_t place = properties_->placeOf(voxel);
            if (place == BrickMap::kNowhere || !isProtected(properties_->materialAt(place))) return;
            if (is_damaged_.has(place) || !isDestroyed(tick, X_TV, voxel, place)) return;
            is_damaged_.set(place);
            ++destroyed.voxels;
            destroyed.material = properties_->materialAt(place);
        });
    }
    bool isDestroyed(const EffectTick& tick, const Pose& X_TV, const Eigen::Vector3i& voxel,
                     size_t place) const noexcept {
        const VoxelVolume& volume = bone_.volume;
        const Density iso = volume.iso();
        if (properties_->originalAt(place) >= iso && volume.at(voxel.x(), voxel.y(), voxel.z()) < iso)
            return true;
        const Eigen::Vector3d p_V = volume.spacing().cwiseProduct(voxel.cast<double>());
        return isCutting(tick) && tick.tool->burr.signedDistance(X_TV * p_V) < 0;
    }

    ProtectedStructuresConfig config_;
    std::shared_ptr<const BoneProperties> properties_;
    std::shared_ptr<const DistanceField> field_;
    const BoneModel& bone_;
    std::array<bool, kMaxMaterials + 1> is_protected_{};
    PlaceMarks is_damaged_;           // by place in properties_
    Eigen::Vector2i next_row_{0, 0};  // y, z: where the last tick's search ended
    size_t damaged_ = 0;              // voxels
    bool is_put_back_ = false;        // in this tick: the bone is on its way to the scan
};

}  // namespace

std::unique_ptr<HapticEffect> ProtectedStructuresConfig::make(const EffectNeeds& needs) const {
    return std::make_unique<ProtectedStructures>(*this, needs.all, needs.bone);
}

}  // namespace bonemill

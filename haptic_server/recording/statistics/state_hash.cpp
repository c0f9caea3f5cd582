#include "haptic_server/recording/statistics/state_hash.h"

#include <bit>
#include <vector>

namespace bonemill {

static_assert(std::endian::native == std::endian::little, "the digest is defined over little-endian bytes");
static_assert(offsetof(EffectRecord, own) == 15 * sizeof(float), "no padding goes into the digest");

void StateHash::addBytes(const void* data, size_t size) noexcept {
    constexpr uint64_t kFnvPrime = 1099511628211ull;
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * kFnvPrime;
}

void StateHash::addRecord(const TickRecord& record, const RecordedEffects& recorded) noexcept {
    const auto add = [this](const auto& field) { addBytes(&field, sizeof field); };
    add(record.tick), add(record.t_s);
    add(record.p_WT), add(record.q_WT), add(record.p_WT_device), add(record.q_WT_device);
    add(record.f_hand_W), add(record.t_hand_W);
    add(record.max_penetration), add(record.contacts);
    add(record.removed_voxels), add(record.added_voxels), add(record.buttons), add(record.faults);
    addEffects(record.effects, recorded);
}

void StateHash::addEffects(const EffectRecord& effects, const RecordedEffects& recorded) noexcept {
    if (recorded.any()) addBytes(&effects, offsetof(EffectRecord, own));
    for (size_t slot = 0; slot < kMaxOwnFigures; ++slot)
        if (recorded.own >> slot & 1u) addBytes(&effects.own[slot], sizeof effects.own[slot]);
}

void StateHash::addVolume(const VoxelVolume& volume) {
    const Eigen::Vector3i& dims = volume.dims();
    std::vector<Density> row(size_t(dims.x()) + VoxelVolume::kReadSlack);
    for (int k = 0; k < dims.z(); ++k)
        for (int j = 0; j < dims.y(); ++j) {
            volume.readRow({0, j, k}, dims.x(), row.data());
            addBytes(row.data(), size_t(dims.x()) * sizeof(Density));
        }
}

}  // namespace bonemill

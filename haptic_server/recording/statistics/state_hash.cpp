#include "haptic_server/recording/statistics/state_hash.h"

#include <bit>
#include <vector>

namespace bonemill {
namespace {

template <class... Fields>
void add(StateHash& hash, const Fields&... fields) noexcept {
    (hash.addBytes(&fields, sizeof fields), ...);
}

}  // namespace

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

void TickHash::add(const TickRecord& r) noexcept {
    auto& [hand, tool, force, contact, removal, effects] = parts_;
    const uint32_t faults = r.faults & ~uint32_t(kFaultOverrun);  // the clock's word
    bonemill::add(hand, r.tick, r.t_s, r.p_WT_device, r.q_WT_device, r.buttons);
    bonemill::add(tool, r.p_WT, r.q_WT);
    bonemill::add(force, r.f_hand_W, r.t_hand_W);
    bonemill::add(contact, r.max_penetration, r.contacts, r.candidates, r.iterations, faults);
    bonemill::add(removal, r.removed_voxels, r.added_voxels, r.removed, r.added);
    effects.addEffects(r.effects, recorded_);
}

std::array<uint64_t, TickHash::kParts> TickHash::parts() const noexcept {
    std::array<uint64_t, kParts> values{};
    for (size_t n = 0; n < kParts; ++n) values[n] = parts_[n].value();
    return values;
}

uint16_t TickHash::check() const noexcept {
    uint64_t sum = 0;
    for (const StateHash& part : parts_) sum += part.value();
    return uint16_t(sum);
}

}  // namespace bonemill

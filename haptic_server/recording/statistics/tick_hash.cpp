#include "haptic_server/recording/statistics/tick_hash.h"

namespace bonemill {
namespace {

template <class... Fields>
void add(StateHash& hash, const Fields&... fields) noexcept {
    (hash.addBytes(&fields, sizeof fields), ...);
}

}  // namespace

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

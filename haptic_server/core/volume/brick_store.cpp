#include "haptic_server/core/volume/brick_store.h"

#include <algorithm>

namespace bonemill {
namespace {

bool isUniform(const Density* contents) {
    return (contents[0] == 0 || contents[0] == kMaxDensity) &&
           std::all_of(contents, contents + kBrickSize, [&](Density d) { return d == contents[0]; });
}

}  // namespace

BrickStore::BrickStore(const Eigen::Vector3i& voxels)
    : bricks_((voxels.array() + kBrickCells - 1) / kBrickCells), slots_(size_t(bricks_.prod()), kAirSlot) {
    setPoolSize(kSharedSlots);
    std::fill_n(pool_.data() + kSolidSlot * kBrickSize, kBrickSize, kMaxDensity);
}

BrickStore BrickStore::withoutSpare() const {
    BrickStore copy(Eigen::Vector3i::Zero());
    copy.bricks_ = bricks_;
    copy.slots_ = slots_;
    copy.pool_ = DensityPool({pool_.data(), used_ * kBrickSize});
    copy.used_ = used_;
    return copy;
}

void BrickStore::open(BrickId brick) noexcept {
    BONEMILL_ASSERT(sharedDensity(brick) && spareCount() > 0);
    const Density density = *sharedDensity(brick);
    Density* contents = pool_.data() + used_ * kBrickSize;
    std::fill_n(contents, kBrickSize, density);
    std::atomic_ref<uint32_t>(slots_[brick]).store(uint32_t(used_++), std::memory_order_release);
}

void BrickStore::adoptNextSpare(BrickId brick) noexcept {
    BONEMILL_ASSERT(spareCount() > 0);
    const Density* contents = nextSpare();
    const bool is_shared = isUniform(contents);
    slots_[brick] = !is_shared ? uint32_t(used_++) : contents[0] == 0 ? kAirSlot : kSolidSlot;
}

void BrickStore::shareUniformBricks() {
    std::vector<BrickId> brick_in(used_);
    for (BrickId brick = 0; brick < brickCount(); ++brick)
        if (slots_[brick] >= kSharedSlots) brick_in[slots_[brick]] = brick;
    size_t kept = kSharedSlots;
    for (size_t slot = kSharedSlots; slot < used_; ++slot) {
        const Density* contents = pool_.data() + slot * kBrickSize;
        if (isUniform(contents)) {
            slots_[brick_in[slot]] = contents[0] == 0 ? kAirSlot : kSolidSlot;
            continue;
        }
        std::copy_n(contents, kBrickSize, pool_.data() + kept * kBrickSize);
        slots_[brick_in[slot]] = uint32_t(kept++);
    }
    used_ = kept;
    dropSpare();
}

}  // namespace bonemill

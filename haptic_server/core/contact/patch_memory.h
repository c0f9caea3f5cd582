// It remembers how finely each patch near the tool is sampled. A patch that changed it while in contact would
// change the energy, so it keeps it until it is no longer near.
//
// It is a table of fixed size, searched in a few slots per patch; a patch that finds no slot is new every
// time. It is RT-safe but for construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "haptic_server/core/contact/patch_id.h"

namespace bonemill {

class PatchMemory {
  public:
    static constexpr uint8_t kNew = 255;

    // The memory is good for about half of most_patches, which is a power of two. It allocates.
    explicit PatchMemory(size_t most_patches) : slots_(most_patches) {}

    // From now on only patches that were asked for since the last call are known.
    void nextGathering() noexcept { ++gathering_; }
    void forget() noexcept { gathering_ += 2; }

    // The level of this patch: what is written stays for the next gathering. kNew: it is not known.
    uint8_t& levelOf(PatchId patch) noexcept {
        Slot* free = nullptr;
        for (size_t n = 0; n < kProbes; ++n) {
            Slot& slot = slots_[(home(patch) + n) & (slots_.size() - 1)];
            const bool is_known = slot.gathering + 1 >= gathering_;
            if (is_known && slot.patch == patch) {
                slot.gathering = gathering_;
                return slot.level;
            }
            if (!is_known && free == nullptr) free = &slot;
        }
        if (free == nullptr) return nowhere_ = kNew;
        *free = {patch, gathering_, kNew};
        return free->level;
    }

  private:
    struct Slot {
        PatchId patch;
        uint64_t gathering = 0;  // the last that asked for it
        uint8_t level = kNew;
    };
    static constexpr size_t kProbes = 8;
    static size_t home(PatchId patch) noexcept { return size_t(patch.packed() * 0x9E3779B97F4A7C15u >> 32); }

    std::vector<Slot> slots_;
    uint64_t gathering_ = 2;
    uint8_t nowhere_ = kNew;
};

}  // namespace bonemill

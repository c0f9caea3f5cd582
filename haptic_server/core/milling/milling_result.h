// This is what one tick's milling did to the bone.
#pragma once

#include <cstdint>

#include "haptic_server/core/volume/index_box.h"

namespace bonemill {

struct MillingResult {
    IndexBox changed;             // voxels whose density changed; empty if none
    uint32_t removed_voxels = 0;  // fell below the iso-value
    uint32_t added_voxels = 0;    // rose to the iso-value or above
    bool shell_is_complete = true;
    bool is_cut_short = false;  // the tick's cells were not enough
    bool has_room = true;       // false: no memory for some bricks to be changed, and they were not

    void include(const MillingResult& other) noexcept {
        changed.include(other.changed);
        removed_voxels += other.removed_voxels;
        added_voxels += other.added_voxels;
        shell_is_complete &= other.shell_is_complete;
        is_cut_short |= other.is_cut_short;
        has_room &= other.has_room;
    }
};

}  // namespace bonemill

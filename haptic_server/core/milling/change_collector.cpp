#include "haptic_server/core/milling/change_collector.h"

namespace bonemill {

bool ChangeCollector::takePart(VoxelVolume& volume, size_t looked_at, const MillingResult& of_part,
                               MillingResult& of_leaf) noexcept {
    const size_t cells_before = std::exchange(cells_, cells_ + looked_at + size_t(of_part.changed.count()));
    if (cells_ > most_cells_ && cells_before > 0) {
        changes_.backTo(part_begin_);
        return false;
    }
    if (of_part.changed.isEmpty()) return true;
    if (!volume.openBricksIn(of_part.changed)) {
        changes_.backTo(part_begin_);
        of_leaf.has_room = false;
        return true;
    }
    of_leaf.include(of_part);
    return true;
}

}  // namespace bonemill

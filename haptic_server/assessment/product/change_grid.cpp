#include "haptic_server/assessment/product/change_grid.h"

namespace bonemill {

ChangeGrid::ChangeGrid(const IndexBox& box, const VoxelVolume& scanned, const VoxelVolume& now,
                       const JudgedTask& task)
    : box_(box), size_(box.max - box.min + Eigen::Vector3i::Ones()), spacing_(scanned.spacing()) {
    bits_.reserve(size_t(box.count()));
    const Density iso = scanned.iso();
    forEachIndex(box, [&](const Eigen::Vector3i& v) {
        const bool was = scanned.at(v.x(), v.y(), v.z()) >= iso, is = now.at(v.x(), v.y(), v.z()) >= iso;
        const bool is_ideal = was && task.isIdeal(v);
        bits_.push_back(uint8_t((was ? kWasBone : 0) | (is ? kIsBone : 0) | (is_ideal ? kIsIdeal : 0)));
    });
}

}  // namespace bonemill

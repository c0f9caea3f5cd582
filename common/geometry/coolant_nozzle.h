// Where a handpiece has its coolant's nozzle unless the scene says otherwise. RT-safe and thread-safe.
#pragma once

#include <Eigen/Core>

namespace bonemill {

// p_TN, m: beside the tool's axis and behind the burr.
inline Eigen::Vector3d usualNozzle(double burr_radius) noexcept {
    return burr_radius * Eigen::Vector3d(2.2, 7, 0);
}

}  // namespace bonemill

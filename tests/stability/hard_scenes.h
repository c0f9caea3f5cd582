// Several hard cases share these bodies; each comes with the pose where its tool starts.
#pragma once

#include "common/base/units.h"
#include "tests/stability/scene.h"

namespace bonemill::test {

// These are the figures of a run that gave something not finite, and of one in which the tool lost the bone
// it was pushed against.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kLost = std::numeric_limits<double>::infinity();

inline Pose upright(const Eigen::Vector3d& position) {
    return {position, Eigen::Quaterniond::Identity()};
}

// Bone is below z = kTop in a cube of 5 mm.
inline constexpr double kTop = 2.5e-3;
inline const Eigen::Vector3d kMiddle(2.55e-3, 2.45e-3, kTop);  // on the surface, off the grid
inline VoxelVolume planeBone() {
    return bodyVolume(boxOf(Eigen::Vector3d::Constant(5e-3)), halfSpace(kMiddle, Eigen::Vector3d::UnitZ()));
}
// The burr just touches the plane, raised by `height`.
inline Pose abovePlane(double height) {
    return upright(kMiddle + Eigen::Vector3d(0, 0, kBurrRadius + height));
}

// The round hole leaves half a voxel of clearance around the peg; the peg sticks out at both ends.
inline const Eigen::Vector3d kHoleMiddle(2.02e-3, 2.0e-3, 1.97e-3);
inline VoxelVolume holeBone() {
    return bodyVolume(boxOf(Eigen::Vector3d::Constant(4e-3)),
                      holeAlongY(kHoleMiddle, kBurrRadius + kVoxel / 2));
}
inline TestTool peg() {
    return pegTool(kBurrRadius, 3e-3);
}

inline constexpr double degrees(double angle) {
    return angle * kDegree;
}

}  // namespace bonemill::test

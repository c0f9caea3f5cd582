// Puts a burr on a short shaft over simple bone.
#pragma once

#include "haptic_server/lab/accuracy_report/probing_path.h"
#include "haptic_server/scene/tool_build/build_tool.h"
#include "tests/support/test_bodies.h"

namespace bonemill::test {

inline constexpr double kBurr = 1e-3;

inline ToolModel burrTool() {
    return std::move(buildTool({}).model);  // the thesis' tool, burr of 1 mm
}

// The shaft points upwards.
inline Eigen::Quaterniond upright() {
    return rotationBetween(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ());
}

inline BoneModel boneOf(VoxelVolume volume, const std::vector<int>& factors = {1}) {
    ShellConfig config{.levels = {}};
    for (const int factor : factors) config.levels.push_back({factor});
    return BoneModel(std::move(volume), Eigen::Vector3i::Constant(16), config);
}

// Its upper side is at z = 3 mm, and it is 6 mm wide.
inline BoneModel floorBone() {
    return boneOf(bodyVolume(cubeGeometry(49, 0.125e-3), halfSpace({0, 0, 3e-3}, Eigen::Vector3d::UnitZ())),
                  {1, 2, 3});
}

}  // namespace bonemill::test

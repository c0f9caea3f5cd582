// Makes a block of bone with protected voxels in it, and a tick over it.
#pragma once

#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/scans/densify/distance_transform.h"
#include "tests/support/led_tick.h"
#include "tests/support/test_bodies.h"

namespace bonemill::test {

inline constexpr double kVoxel = 0.125e-3;
inline constexpr double kBurr = 1e-3;
inline constexpr double kTop = 5e-3;  // bone fills z < kTop (V)
inline constexpr MaterialId kNerve = 2;

// Material 1 is plain, material 2 protected.
inline MaterialTable tissueTable() {
    MaterialTable table(3);
    table[kNerve].is_protected = true;
    return table;
}

struct TissueBench {
    // The distance `nerve` is negative where voxels are of the protected material.
    explicit TissueBench(const DistanceFunction& nerve, double reach = 4e-3)
        : bone(bodyVolume(cubeGeometry(64, kVoxel), halfSpace({0, 0, kTop}, Eigen::Vector3d::UnitZ())),
               Eigen::Vector3i::Constant(16), ShellConfig{}),
          tool(sphereToolModel(kBurr, kVoxel)) {
        config.tool.burr.radius = kBurr;
        EffectConfigs& effects = config.effects;
        effects.materials = tissueTable();
        effects.properties =
            std::make_shared<const BoneProperties>(bone.volume, [&](const Eigen::Vector3i& v) {
                return nerve(kVoxel * v.cast<double>()) < 0 ? kNerve : kNoMaterial;
            });
        effects.protected_field =
            protectedDistance(*effects.properties, effects.materials, bone.volume.spacing(), reach);
    }
    static Pose at(const Eigen::Vector3d& p_V) { return {p_V, Eigen::Quaterniond::Identity()}; }
    FixedTick makeTick(BoneHistory* history = nullptr) {
        config.tool.model = &tool;
        return {config, bone, history};
    }
    std::vector<TickRecord> run(FixedTick& tick, const std::vector<DeviceInput>& inputs) {
        return lead(tick, inputs);
    }

    FixedTickConfig config;
    BoneModel bone;
    ToolModel tool;
};

}  // namespace bonemill::test

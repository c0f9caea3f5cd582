// Has the bone, tool and settings of one stability run, and the analytic bodies of the hard cases.
//
// Frame V is W here: poses and distances mean the same in both.
#pragma once

#include <functional>
#include <string>

#include "tests/stability/variant.h"
#include "tests/support/test_bodies.h"

namespace bonemill::test {

inline constexpr double kVoxel = 0.125e-3;  // m, also the tools' SDF spacing unless said otherwise
inline constexpr double kBurrRadius = 1e-3;

// It is a tool in the ways that the accuracy settings can ask for.
struct TestTool {
    SdfGrid grid;
    std::vector<ToolShape> shapes;  // none: only the grid
    double thinnest_radius;         // m
};

struct Scene {
    // `edit` has the last word over the variant's settings. The bone has contact points for these, or, with
    // `every_preset`, for all.
    Scene(VoxelVolume volume, TestTool test_tool, const Variant& variant, double dt = 1e-3,
          const std::function<void(FixedTickConfig&)>& edit = {}, bool every_preset = false);

    // Its tool is without a model; that is `tool`.
    FixedTickConfig config;
    const DeviceCapabilities* device;  // null: none has told of itself
    uint32_t held_buttons;
    size_t averaged_ticks;  // of what is called a residual: so that it leaves the wanted vibration out
    BoneModel bone;
    ToolModel tool;

    HandSide handSide() const { return device ? handSideOf(config, *device) : handSideOf(config); }
    SpoTool spoTool() const { return {&tool, config.tool.burr, config.tool.saturation_force}; }
};

VolumeGeometry boxOf(const Eigen::Vector3d& size, double spacing = kVoxel);  // smallest that holds `size`
SdfGrid gridOf(const DistanceFunction& distance_T, const Eigen::Vector3d& half_size, double spacing = kVoxel);
TestTool burr();                                      // sphere of kBurrRadius
TestTool pegTool(double radius, double half_length);  // round-ended, along y through T's origin

// Makes a block with a round hole along y through `center`.
DistanceFunction holeAlongY(const Eigen::Vector3d& center, double radius);
// Makes a wall of this thickness about the plane through `point`.
DistanceFunction wall(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double thickness);
// Makes a V-groove of full opening angle `angle` (rad) along y, its bottom edge through `edge`,
// open towards +z.
DistanceFunction groove(const Eigen::Vector3d& edge, double angle);

}  // namespace bonemill::test

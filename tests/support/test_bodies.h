// Makes analytic bodies and tools for tests; the density is the linear ramp of an exact signed distance.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/tool/tool_model.h"

namespace bonemill::test {

using DistanceFunction = std::function<double(const Eigen::Vector3d& p_V)>;  // m, negative inside

inline constexpr Density kTestIso = 32768;

inline VolumeGeometry cubeGeometry(int voxels, double spacing) {
    VolumeGeometry geometry;
    geometry.dims.setConstant(voxels);
    geometry.spacing.setConstant(spacing);
    return geometry;
}

// The iso-surface lies where distance(p_V) = 0; density is full 2 voxels inside, and air is 2 voxels outside.
inline VoxelVolume bodyVolume(const VolumeGeometry& geometry, const DistanceFunction& distance) {
    VoxelVolume volume(geometry, kTestIso);
    const double ramp = 4 * geometry.spacing.maxCoeff();
    for (int k = 0; k < geometry.dims.z(); ++k)
        for (int j = 0; j < geometry.dims.y(); ++j)
            for (int i = 0; i < geometry.dims.x(); ++i) {
                const Eigen::Vector3d p_V = geometry.spacing.cwiseProduct(Eigen::Vector3d(i, j, k));
                const double density = kTestIso - distance(p_V) / ramp * kMaxDensity;
                volume.set(i, j, k, Density(std::lround(std::clamp(density, 0.0, double(kMaxDensity)))));
            }
    return volume;
}

inline DistanceFunction sphereAt(const Eigen::Vector3d& center, double radius) {
    return [=](const Eigen::Vector3d& p) { return (p - center).norm() - radius; };
}

// Bone is below the plane through `point` with outward normal `normal`.
inline DistanceFunction halfSpace(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    return [=](const Eigen::Vector3d& p) { return normal.dot(p - point); };
}

// Makes a spherical tool around T's origin.
inline SdfGrid sphereTool(double radius, double spacing) {
    const int half = int(std::ceil(radius / spacing)) + 3;
    const int nodes = 2 * half + 1;
    const Eigen::Vector3d origin = Eigen::Vector3d::Constant(-half * spacing);
    std::vector<float> values;
    for (int k = 0; k < nodes; ++k)
        for (int j = 0; j < nodes; ++j)
            for (int i = 0; i < nodes; ++i)
                values.push_back(float((origin + spacing * Eigen::Vector3d(i, j, k)).norm() - radius));
    return SdfGrid(Eigen::Vector3i::Constant(nodes), spacing, origin, std::move(values));
}

// Makes the same tool with its grid and its exact shape.
inline ToolModel sphereToolModel(double radius, double spacing) {
    return {sphereTool(radius, spacing), {SphereShape{Eigen::Vector3d::Zero(), radius}}, radius};
}

}  // namespace bonemill::test

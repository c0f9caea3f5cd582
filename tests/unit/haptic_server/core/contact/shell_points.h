// The tests of the point shell share this: its levels, and its points in one list.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "haptic_server/core/contact/point_shell.h"

namespace bonemill::test {

inline const std::vector<ShellLevel> kLevels = {{1}, {2}, {3}};

inline std::vector<ShellLevel> levelsOf(const std::vector<int>& factors,
                                        ShellNormals normals = ShellNormals::kCentralDifference) {
    std::vector<ShellLevel> levels;
    for (const int factor : factors) levels.push_back({factor, normals});
    return levels;
}

// These are all points of a leaf; each lies within its block.
inline std::vector<ShellPoint> pointsOf(const PointShell& shell, int level, LeafId leaf) {
    std::vector<ShellPoint> points;
    shell.forEachBlock(level, leaf, [&](const ShellBlock& b, uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) {
            points.push_back({{b.x[i], b.y[i], b.z[i]}, {b.nx[i], b.ny[i], b.nz[i]}, b.area[i], b.key[i]});
            EXPECT_LE((points.back().position - Eigen::Vector3f(b.center)).norm(), b.radius + 1e-8f);
        }
    });
    return points;
}

}  // namespace bonemill::test

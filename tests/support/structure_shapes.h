// Makes protected structures of exact shape, as a server would send them.
#pragma once

#include <cmath>

#include "common/geometry/node_mesh.h"

namespace bonemill::test {

// The rings lie at N heights; a triangle's middle is nearer to the centre than its corners by a share
// of about (π / 2 kBallRings)² of the radius.
inline constexpr int kBallRings = 48;

inline NodeMesh ballStructure(uint32_t structure, const Eigen::Vector3d& center_V, double radius) {
    constexpr int kSides = 2 * kBallRings;
    NodeMesh mesh;
    mesh.leaf = structure;
    mesh.revision = 1;
    mesh.origin = (center_V - Eigen::Vector3d::Constant(radius)).cast<float>();
    mesh.step = Eigen::Vector3f::Constant(float(2 * radius / 65535));
    for (int ring = 0; ring <= kBallRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            const double height = M_PI * ring / kBallRings, turn = 2 * M_PI * side / kSides;
            const Eigen::Vector3d out(std::sin(height) * std::cos(turn), std::sin(height) * std::sin(turn),
                                      std::cos(height));
            const Eigen::Array3i at = ((out.array() + 1) * 32767.5).round().cast<int>();
            const OctahedralNormal normal = encodeNormal(out.cast<float>());
            mesh.vertices.push_back(
                {uint16_t(at.x()), uint16_t(at.y()), uint16_t(at.z()), normal.u, normal.v});
        }
    for (uint32_t ring = 0; ring < kBallRings; ++ring)
        for (uint32_t side = 0; side < kSides; ++side) {
            const uint32_t a = ring * kSides + side, b = ring * kSides + (side + 1) % kSides;
            mesh.indices.insert(mesh.indices.end(), {a, a + kSides, b, b, a + kSides, b + kSides});
        }
    return mesh;
}

}  // namespace bonemill::test

// This is the surface of one octree leaf as it is stored, sent and drawn: indexed, quantised triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/pose.h"

namespace bonemill {

// The position counts quantisation steps from the leaf's origin. The unit normal points out of the bone, in
// octahedral coding with signed 8 bit per coordinate. That makes 8 bytes, as meshoptimizer's vertex codec
// wants a multiple of 4.
struct PackedVertex {
    uint16_t x, y, z;
    int8_t octahedral_u, octahedral_v;
    bool operator==(const PackedVertex&) const = default;
};
static_assert(sizeof(PackedVertex) == 8);

// A vertex with this bit in its material lies where the scan had bone: milling opened it.
inline constexpr uint8_t kMilledBit = 0x80;
inline constexpr int kMaxVertexMaterials = kMilledBit - 1;

struct NodeMesh {
    uint32_t leaf = 0;                                 // LeafId
    uint32_t revision = 0;                             // leaf version the mesh was made from
    Eigen::Vector3f origin = Eigen::Vector3f::Zero();  // V, m: vertex = origin + step ∘ (x, y, z)
    Eigen::Vector3f step = Eigen::Vector3f::Zero();    // V, m
    std::vector<PackedVertex> vertices;
    std::vector<uint32_t> indices;  // 3 per triangle, counter-clockwise seen from outside
    // Each vertex has 1 + the index of its material in the scene's list, or 0 for none, and kMilledBit; empty
    // if all are 0.
    std::vector<uint8_t> materials;

    bool isEmpty() const noexcept { return indices.empty(); }
};

// Returns where a vertex of this mesh lies (V, m).
inline Eigen::Vector3f positionOf(const NodeMesh& mesh, const PackedVertex& v) {
    return mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z));
}

// The octahedral coding of a unit vector n (Cigolle et al. 2014, "Survey of Efficient Representations for
// Independent Unit Vectors") is (u, v) = (n.x, n.y) / (|n.x| + |n.y| + |n.z|), folded over the diagonals
// when n.z < 0, times 127. The worst error of a normal is below 1.5 degrees. Both functions are thread-safe
// and never throw.
struct OctahedralNormal {
    int8_t u, v;
};
OctahedralNormal encodeNormal(const Eigen::Vector3f& normal) noexcept;  // of any length but 0
Eigen::Vector3f decodeNormal(int8_t octahedral_u, int8_t octahedral_v) noexcept;

}  // namespace bonemill

// A node's triangles by place, so that a picture of a small part of the bone need not draw whole nodes. It is
// for any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/node_mesh.h"

namespace bonemill {

// Triangles that lie together.
struct NodePart {
    uint32_t first = 0, count = 0;  // of the sorted indices
    Eigen::AlignedBox3f box;        // around them (V, m)
};

struct SortedTriangles {
    std::vector<uint32_t> indices;  // 3 per triangle: those of the mesh in another order
    std::vector<NodePart> parts;    // one after the other, without gaps; none is empty
};

// Sorts the triangles by the cell of a coarse grid that their first vertex lies in, and keeps their order
// within a cell. Each index must have its vertex.
SortedTriangles sortedByPlace(const NodeMesh& mesh);

}  // namespace bonemill

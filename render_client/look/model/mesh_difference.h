// Finds where two versions of a node's surface differ. The function is pure; any thread may call it.
#pragma once

#include <Eigen/Geometry>

#include "common/geometry/node_mesh.h"

namespace bonemill {

// Returns the box (V, m) around the triangles that only one of them has; it is empty when both show the same.
Eigen::AlignedBox3f differenceBox(const NodeMesh& before, const NodeMesh& after);

// Returns where a vertex of this mesh lies (V, m).
inline Eigen::Vector3f positionOf(const NodeMesh& mesh, const PackedVertex& v) {
    return mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z));
}

// Returns the box (V, m) around all triangles.
Eigen::AlignedBox3f boxOf(const NodeMesh& mesh);

}  // namespace bonemill

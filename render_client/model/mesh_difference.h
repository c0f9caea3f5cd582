// Where two versions of a node's surface differ. Pure function, any thread.
#pragma once

#include <Eigen/Geometry>

#include "common/geometry/node_mesh.h"

namespace bonemill {

// Around the triangles that only one of them has, V, m; empty when both show the same.
Eigen::AlignedBox3f differenceBox(const NodeMesh& before, const NodeMesh& after);

// Around all its triangles, V, m.
Eigen::AlignedBox3f boxOf(const NodeMesh& mesh);

}  // namespace bonemill

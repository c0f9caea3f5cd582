// It is the exact signed distance to a closed triangle mesh.
//
// The distance is that to the nearest point of the nearest triangle, found in a tree of axis-parallel boxes.
// The sign goes by the angle-weighted pseudonormal of the feature (face, edge or vertex) that holds the
// nearest point; J. A. Bærentzen, H. Aanæs, "Signed Distance Computation Using the Angle Weighted
// Pseudonormal", IEEE TVCG 11(3), 2005. It is right wherever the mesh does not pass through itself. The class
// is for start-up only, since it allocates.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/scans/solid_mesh/mesh_file.h"

namespace bonemill {

class MeshDistance {
  public:
    // Keeps a reference to `mesh`, which holds at least one triangle.
    explicit MeshDistance(const TriangleMesh& mesh);

    struct Nearest {
        double distance;    // m, negative inside
        uint32_t triangle;  // that holds the nearest point
    };
    // `guess` is any triangle; one that is near, such as the last answer for a point close by, saves most
    // of the search.
    Nearest query(const Eigen::Vector3d& p, uint32_t guess = 0) const;

  private:
    struct Node {
        Eigen::AlignedBox3d box;
        uint32_t
            first;  // leaf: its triangles in order_; else the second child, the first one follows this node
        uint32_t count;  // triangles of a leaf; 0: inner node
    };
    uint32_t build(uint32_t first, uint32_t last, const std::vector<Eigen::AlignedBox3d>& boxes);
    Eigen::Vector3d pseudonormal(uint32_t triangle, int feature) const;
    void findNormals();

    const TriangleMesh& mesh_;
    std::vector<Node> nodes_;
    std::vector<uint32_t> order_;
    std::vector<Eigen::Vector3d> face_normals_;    // unit; zero for a triangle without area
    std::vector<Eigen::Vector3d> vertex_normals_;  // sums, weighted by angle
};

}  // namespace bonemill

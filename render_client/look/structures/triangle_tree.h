// Finds the place of a surface that is nearest to a point, and where a ray meets it first.
//
// It is a tree of boxes around the triangles of one mesh, in V and m. Reading is thread-safe.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "common/geometry/node_mesh.h"

namespace bonemill {

struct NearestPlace {
    Eigen::Vector3f p_V;
    float distance;  // m, negative for a point within the closed surface
};

class TriangleTree {
  public:
    static constexpr float kAnyDistance = std::numeric_limits<float>::max();

    // The indices must name vertices.
    explicit TriangleTree(const NodeMesh& mesh);

    const Eigen::AlignedBox3f& box() const { return box_; }

    // There is none at `within` or farther.
    std::optional<NearestPlace> nearest(const Eigen::Vector3f& p_V, float within = kAnyDistance) const;
    // Returns how many times the direction's length it is to the first triangle, seen from either side;
    // there is none at `within` or farther.
    std::optional<float> firstHit(const Eigen::Vector3f& from_V, const Eigen::Vector3f& direction_V,
                                  float within = kAnyDistance) const;

  private:
    struct Triangle {
        std::array<uint32_t, 3> corners;
    };
    // Its children stand at `first` and the next place, or its triangles from `first` on.
    struct Node {
        Eigen::AlignedBox3f box;
        uint32_t first = 0;
        uint32_t count = 0;  // 0: it has children
    };
    void build(uint32_t node, uint32_t first, uint32_t last);
    Eigen::AlignedBox3f boxOf(const Triangle& triangle) const;
    struct Closest {
        float squared;
        uint32_t triangle;
        Eigen::Vector3f weights;  // of its corners
    };
    void lookIn(uint32_t node, const Eigen::Vector3f& p_V, Closest& closest) const;

    std::vector<Eigen::Vector3f> positions_, normals_;
    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
    Eigen::AlignedBox3f box_;
};

}  // namespace bonemill

#include "haptic_server/scans/solid_mesh/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/math/pinned_math.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr uint32_t kLeafTriangles = 4;

// It says where on a triangle the nearest point lies: a corner, an edge (from corner e to the next)
// or the face.
enum Feature { kCorner0 = 0, kEdge0 = 3, kFace = 6 };

struct Closest {
    Vector3d point = Vector3d::Zero();
    int feature = kFace;
    double distance2 = std::numeric_limits<double>::infinity();
};

void tryEdge(const Vector3d& p, const Vector3d& a, const Vector3d& b, int edge, Closest& best) {
    const Vector3d ab = b - a;
    const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    const Vector3d point = t == 1 ? b : Vector3d(a + t * ab);
    const double distance2 = (p - point).squaredNorm();
    if (distance2 >= best.distance2) return;
    const int feature = t == 0 ? kCorner0 + edge : t == 1 ? kCorner0 + (edge + 1) % 3 : kEdge0 + edge;
    best = {point, feature, distance2};
}

// A unit_normal of zero says that there is no area, only edges.
Closest closestOn(const std::array<Vector3d, 3>& v, const Vector3d& unit_normal, const Vector3d& p) {
    bool above_face = unit_normal != Vector3d::Zero();
    for (int e = 0; e < 3 && above_face; ++e)
        above_face = unit_normal.cross(v[(e + 1) % 3] - v[e]).dot(p - v[e]) > 0;
    if (above_face) {
        const double height = unit_normal.dot(p - v[0]);
        return {p - height * unit_normal, kFace, height * height};
    }
    Closest best;
    for (int e = 0; e < 3; ++e) tryEdge(p, v[e], v[(e + 1) % 3], e, best);
    return best;
}

double angleAt(const Vector3d& corner, const Vector3d& a, const Vector3d& b) {
    const Vector3d u = a - corner, v = b - corner;
    return pinned::atan2(u.cross(v).norm(), u.dot(v));
}

}  // namespace

MeshDistance::MeshDistance(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    std::vector<Eigen::AlignedBox3d> boxes(order_.size());
    for (uint32_t t = 0; t < boxes.size(); ++t)
        for (int c = 0; c < 3; ++c) boxes[t].extend(mesh.vertex(t, c));
    nodes_.reserve(order_.size());
    build(0, uint32_t(order_.size()), boxes);
    findNormals();
}

uint32_t MeshDistance::build(uint32_t first, uint32_t last, const std::vector<Eigen::AlignedBox3d>& boxes) {
    const auto id = uint32_t(nodes_.size());
    nodes_.push_back({{}, first, last - first});
    Eigen::AlignedBox3d box, centers;
    for (uint32_t i = first; i < last; ++i) {
        box.extend(boxes[order_[i]]);
        centers.extend(boxes[order_[i]].center());
    }
    nodes_[id].box = box;
    if (last - first <= kLeafTriangles) return id;

    int axis = 0;
    centers.sizes().maxCoeff(&axis);
    const uint32_t middle = first + (last - first) / 2;
    std::nth_element(
        order_.begin() + first, order_.begin() + middle, order_.begin() + last,
        [&](uint32_t a, uint32_t b) { return boxes[a].center()[axis] < boxes[b].center()[axis]; });
    build(first, middle, boxes);
    const uint32_t second = build(middle, last, boxes);
    nodes_[id].first = second;
    nodes_[id].count = 0;
    return id;
}

void MeshDistance::findNormals() {
    face_normals_.resize(mesh_.triangles.size());
    vertex_normals_.assign(mesh_.vertices.size(), Vector3d::Zero());
    for (uint32_t t = 0; t < face_normals_.size(); ++t) {
        face_normals_[t] = mesh_.areaNormal(t).stableNormalized();
        for (int c = 0; c < 3; ++c)
            vertex_normals_[mesh_.triangles[t][c]] +=
                angleAt(mesh_.vertex(t, c), mesh_.vertex(t, c + 1), mesh_.vertex(t, c + 2)) *
                face_normals_[t];
    }
}

Vector3d MeshDistance::pseudonormal(uint32_t triangle, int feature) const {
    if (feature == kFace) return face_normals_[triangle];
    if (feature >= kEdge0)
        return face_normals_[triangle] + face_normals_[mesh_.neighbours[triangle][feature - kEdge0]];
    return vertex_normals_[mesh_.triangles[triangle][feature]];
}

MeshDistance::Nearest MeshDistance::query(const Vector3d& p, uint32_t guess) const {
    Closest best;
    uint32_t best_triangle = guess;
    const auto tryTriangle = [&](uint32_t t) {
        const Closest c =
            closestOn({mesh_.vertex(t, 0), mesh_.vertex(t, 1), mesh_.vertex(t, 2)}, face_normals_[t], p);
        if (c.distance2 >= best.distance2) return;
        best = c;
        best_triangle = t;
    };
    tryTriangle(guess);

    struct Pending {
        uint32_t node;
        double distance2;
    };
    std::array<Pending, 64> stack;  // halving 2^32 triangles needs 32 levels
    size_t depth = 0;
    stack[depth++] = {0, nodes_[0].box.squaredExteriorDistance(p)};
    while (depth > 0) {
        const Pending pending = stack[--depth];
        if (pending.distance2 >= best.distance2) continue;
        const Node& node = nodes_[pending.node];
        for (uint32_t i = 0; i < node.count; ++i) tryTriangle(order_[node.first + i]);
        if (node.count > 0) continue;
        Pending near{pending.node + 1, nodes_[pending.node + 1].box.squaredExteriorDistance(p)};
        Pending far{node.first, nodes_[node.first].box.squaredExteriorDistance(p)};
        if (far.distance2 < near.distance2) std::swap(near, far);
        stack[depth++] = far;
        stack[depth++] = near;
    }
    const bool inside = (p - best.point).dot(pseudonormal(best_triangle, best.feature)) < 0;
    const double distance = std::sqrt(best.distance2);
    return {inside ? -distance : distance, best_triangle};
}

}  // namespace bonemill

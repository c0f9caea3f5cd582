#include "render_client/look/structures/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

using Eigen::Vector3f;

constexpr uint32_t kLeafTriangles = 6;

// Returns the weights of the corners at the triangle's point that is nearest to p (Ericson, Real-Time
// Collision Detection, 5.1.5).
Vector3f nearestWeights(const Vector3f& p, const Vector3f& a, const Vector3f& b, const Vector3f& c) {
    const Vector3f ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const float d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const float d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    const float d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const float va = d3 * d6 - d5 * d4, bc = d4 - d3, cb = d5 - d6;
    if (va <= 0 && bc >= 0 && cb >= 0) return {0, 1 - bc / (bc + cb), bc / (bc + cb)};
    const float sum = va + vb + vc;
    if (!(sum > 0)) return {1, 0, 0};  // it has no area
    return {va / sum, vb / sum, vc / sum};
}

bool meetsBox(const Eigen::AlignedBox3f& box, const Vector3f& from, const Vector3f& inverse, float within) {
    const Eigen::Array3f low = (box.min() - from).array() * inverse.array();
    const Eigen::Array3f high = (box.max() - from).array() * inverse.array();
    return low.max(high).minCoeff() >= std::max(low.min(high).maxCoeff(), 0.0f) &&
           low.min(high).maxCoeff() < within;
}

// Möller and Trumbore (1997).
std::optional<float> hitTriangle(const Vector3f& from, const Vector3f& direction, const Vector3f& a,
                                 const Vector3f& b, const Vector3f& c) {
    const Vector3f ab = b - a, ac = c - a, across = direction.cross(ac);
    const float determinant = ab.dot(across);
    if (determinant == 0) return std::nullopt;
    const Vector3f start = from - a, turned = start.cross(ab);
    const float u = start.dot(across) / determinant, v = direction.dot(turned) / determinant;
    const float along = ac.dot(turned) / determinant;
    if (u < 0 || v < 0 || u + v > 1 || !(along > 0)) return std::nullopt;
    return along;
}

}  // namespace

TriangleTree::TriangleTree(const NodeMesh& mesh) {
    for (const PackedVertex& v : mesh.vertices) {
        positions_.push_back(mesh.origin + mesh.step.cwiseProduct(Vector3f(v.x, v.y, v.z)));
        normals_.push_back(decodeNormal(v.octahedral_u, v.octahedral_v));
    }
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        triangles_.push_back({{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]}});
    if (triangles_.empty()) return;
    nodes_.emplace_back();
    build(0, 0, uint32_t(triangles_.size()));
    box_ = nodes_[0].box;
}

Eigen::AlignedBox3f TriangleTree::boxOf(const Triangle& triangle) const {
    Eigen::AlignedBox3f box;
    for (const uint32_t corner : triangle.corners) box.extend(positions_[corner]);
    return box;
}

// Halves the triangles by the order of their middles: the tree is as deep as the count's logarithm.
void TriangleTree::build(uint32_t node, uint32_t first, uint32_t last) {
    Eigen::AlignedBox3f box;
    for (uint32_t t = first; t < last; ++t) box.extend(boxOf(triangles_[t]));
    nodes_[node].box = box;
    if (last - first <= kLeafTriangles) {
        nodes_[node].first = first;
        nodes_[node].count = last - first;
        return;
    }
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const uint32_t middle = first + (last - first) / 2;
    const auto place = [&](const Triangle& t) {
        return positions_[t.corners[0]][axis] + positions_[t.corners[1]][axis] +
               positions_[t.corners[2]][axis];
    };
    std::nth_element(triangles_.begin() + first, triangles_.begin() + middle, triangles_.begin() + last,
                     [&](const Triangle& a, const Triangle& b) { return place(a) < place(b); });
    const auto children = uint32_t(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[node].first = children;
    build(children, first, middle);
    build(children + 1, middle, last);
}

void TriangleTree::lookIn(uint32_t at, const Vector3f& p_V, Closest& closest) const {
    const Node& node = nodes_[at];
    if (node.count == 0) {
        uint32_t near = node.first, far = node.first + 1;
        float near_squared = nodes_[near].box.squaredExteriorDistance(p_V);
        float far_squared = nodes_[far].box.squaredExteriorDistance(p_V);
        if (far_squared < near_squared) {
            std::swap(near, far);
            std::swap(near_squared, far_squared);
        }
        if (near_squared < closest.squared) lookIn(near, p_V, closest);
        if (far_squared < closest.squared) lookIn(far, p_V, closest);
        return;
    }
    for (uint32_t t = node.first; t < node.first + node.count; ++t) {
        const auto& c = triangles_[t].corners;
        const Vector3f& a = positions_[c[0]];
        const Vector3f& b = positions_[c[1]];
        const Vector3f& d = positions_[c[2]];
        const Vector3f weights = nearestWeights(p_V, a, b, d);
        const float squared = (weights.x() * a + weights.y() * b + weights.z() * d - p_V).squaredNorm();
        if (squared < closest.squared) closest = {squared, t, weights};
    }
}

std::optional<NearestPlace> TriangleTree::nearest(const Vector3f& p_V, float within) const {
    if (nodes_.empty()) return std::nullopt;
    const float limit = within < kAnyDistance ? within * within : kAnyDistance;
    Closest closest{limit, UINT32_MAX, Vector3f::Zero()};
    lookIn(0, p_V, closest);
    if (closest.triangle == UINT32_MAX) return std::nullopt;
    NearestPlace place{Vector3f::Zero(), std::sqrt(closest.squared)};
    Vector3f normal = Vector3f::Zero();
    for (int i = 0; i < 3; ++i) {
        const uint32_t corner = triangles_[closest.triangle].corners[size_t(i)];
        place.p_V += closest.weights[i] * positions_[corner];
        normal += closest.weights[i] * normals_[corner];
    }
    if (normal.dot(p_V - place.p_V) < 0) place.distance = -place.distance;
    return place;
}

std::optional<float> TriangleTree::firstHit(const Vector3f& from_V, const Vector3f& direction_V,
                                            float within) const {
    float first = within;
    const Vector3f inverse = direction_V.cwiseInverse();
    std::vector<uint32_t> todo;
    if (!nodes_.empty()) todo.push_back(0);
    while (!todo.empty()) {
        const Node& node = nodes_[todo.back()];
        todo.pop_back();
        if (!meetsBox(node.box, from_V, inverse, first)) continue;
        if (node.count == 0) {
            todo.insert(todo.end(), {node.first, node.first + 1});
            continue;
        }
        for (uint32_t t = node.first; t < node.first + node.count; ++t) {
            const auto& c = triangles_[t].corners;
            const auto hit =
                hitTriangle(from_V, direction_V, positions_[c[0]], positions_[c[1]], positions_[c[2]]);
            if (hit) first = std::min(first, *hit);
        }
    }
    return first < within ? std::optional(first) : std::nullopt;
}

}  // namespace bonemill

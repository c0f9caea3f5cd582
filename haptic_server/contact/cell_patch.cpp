#include "haptic_server/contact/cell_patch.h"

namespace bonemill {
namespace {

// An edge's low corner and direction in cell steps; four floats, the last 0, are one SSE register.
struct EdgeLine {
    Eigen::Vector4f low;
    Eigen::Vector4f along;
};

std::array<EdgeLine, 12> edgeLines() {
    std::array<EdgeLine, 12> lines;
    for (size_t e = 0; e < lines.size(); ++e) {
        const int low = kCubeEdges[e].low_corner;
        lines[e] = {{float(low & 1), float(low >> 1 & 1), float(low >> 2 & 1), 0},
                    Eigen::Vector4f::Unit(kCubeEdges[e].axis)};
    }
    return lines;
}

const std::array<EdgeLine, 12> kEdgeLines = edgeLines();

// Where the density, linear along the edge, equals iso; cell steps. The corners lie on different sides.
Eigen::Vector4f crossingOn(const CellCorners& corners, size_t edge) noexcept {
    const CubeEdge ends = kCubeEdges[edge];
    const float low = corners.excess[ends.low_corner];
    const float high = corners.excess[size_t(ends.low_corner | 1 << ends.axis)];
    return kEdgeLines[edge].low + low / (low - high) * kEdgeLines[edge].along;
}

}  // namespace

CellPatch makePatch(const CellCorners& corners, const CubeTriangles& triangles,
                    const Eigen::Vector3f& steps) noexcept {
    const Eigen::Vector4f scale(steps.x(), steps.y(), steps.z(), 0);
    float twice_area = 0;
    Eigen::Vector4f moment = Eigen::Vector4f::Zero();
    for (int n = 0; n < triangles.count; ++n) {
        const auto& edges = triangles.edges[size_t(n)];
        const Eigen::Vector4f a = crossingOn(corners, edges[0]);
        const Eigen::Vector4f b = crossingOn(corners, edges[1]);
        const Eigen::Vector4f c = crossingOn(corners, edges[2]);
        const Eigen::Vector4f ab = (b - a).cwiseProduct(scale);
        const Eigen::Vector4f ac = (c - a).cwiseProduct(scale);
        const float twice = ab.cross3(ac).norm();
        twice_area += twice;
        moment += twice * (a + b + c);
    }
    CellPatch patch{twice_area / 2, Eigen::Vector3f::Zero()};
    if (twice_area > 0) patch.centroid = moment.head<3>() / (3 * twice_area);
    return patch;
}

}  // namespace bonemill

// These are obvious and slow oracles for meshes.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "haptic_server/scans/solid_mesh/mesh_file.h"
#include "tests/support/stl_writer.h"

namespace bonemill::test {

// They are as readMeshFile gives them, in m.
inline std::vector<Eigen::Vector3d> cornersOf(const TriangleSoup& soup) {
    std::vector<Eigen::Vector3d> corners;
    for (const SoupTriangle& t : soup)
        for (const Eigen::Vector3f& p : t) corners.push_back(1e-3 * p.cast<double>());
    return corners;
}

inline TriangleSoup insideOut(TriangleSoup soup) {
    for (SoupTriangle& t : soup) std::swap(t[0], t[1]);
    return soup;
}

// Counts how often the surface goes around p, by the triangles' solid angles (A. van Oosterom, J. Strackee,
// IEEE TBME 30, 1983).
inline double windingNumber(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
    double sum = 0;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const Eigen::Vector3d a = mesh.vertex(t, 0) - p, b = mesh.vertex(t, 1) - p, c = mesh.vertex(t, 2) - p;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        sum +=
            2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return sum / (4 * std::numbers::pi);
}

// This is C. Ericson, Real-Time Collision Detection, 5.1.5, written as the minimum over face and edges.
inline double unsignedDistance(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
    double nearest = INFINITY;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        Eigen::Matrix<double, 3, 2> sides;
        sides << mesh.vertex(t, 1) - mesh.vertex(t, 0), mesh.vertex(t, 2) - mesh.vertex(t, 0);
        const Eigen::Vector2d uv =
            (sides.transpose() * sides).inverse() * sides.transpose() * (p - mesh.vertex(t, 0));
        if (uv.minCoeff() >= 0 && uv.sum() <= 1)
            nearest = std::min(nearest, (p - mesh.vertex(t, 0) - sides * uv).norm());
        for (int e = 0; e < 3; ++e) {
            const Eigen::Vector3d a = mesh.vertex(t, e), ab = mesh.vertex(t, e + 1) - a;
            nearest =
                std::min(nearest, (p - a - std::clamp((p - a).dot(ab) / ab.dot(ab), 0.0, 1.0) * ab).norm());
        }
    }
    return nearest;
}

}  // namespace bonemill::test

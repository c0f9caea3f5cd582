#include "haptic_server/scans/solid_mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <tuple>

#include "common/base/units.h"
#include "common/base/user_error.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

std::string inMillimetres(double metres) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g mm", metres * kPerMillimetre);
    return text;
}

void checkCorners(const std::vector<Vector3d>& corners, const std::string& file, const SolidKind& kind) {
    if (corners.size() < 3)
        throw UserError(file + ": holds no triangles; export the " + kind.name + "'s surface as triangles");
    const auto bad =
        std::count_if(corners.begin(), corners.end(), [](const Vector3d& p) { return !p.allFinite(); });
    if (bad > 0)
        throw UserError(file + ": " + std::to_string(bad) + " of " + std::to_string(corners.size()) +
                        " triangle corners are not finite numbers; the file is damaged, export it again");
    Eigen::AlignedBox3d box;
    for (const Vector3d& p : corners) box.extend(p);
    const double size = box.sizes().maxCoeff();
    if (size < kind.smallest || size > kind.largest)
        throw UserError(file + ": the " + kind.name + " is " + inMillimetres(size) +
                        " large; coordinates are read as millimetres, and " + inMillimetres(kind.smallest) +
                        " to " + inMillimetres(kind.largest) + " is accepted. Export it in millimetres");
}

bool before(const Vector3d& a, const Vector3d& b) {
    return std::tie(a.x(), a.y(), a.z()) < std::tie(b.x(), b.y(), b.z());
}

// Fills vertices and triangles; a triangle with two equal corners has no inside and goes.
void weld(const std::vector<Vector3d>& corners, TriangleMesh& mesh) {
    std::vector<uint32_t> order(corners.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return before(corners[a], corners[b]); });
    std::vector<uint32_t> vertex_of(corners.size());
    for (const uint32_t corner : order) {
        if (mesh.vertices.empty() || mesh.vertices.back() != corners[corner])
            mesh.vertices.push_back(corners[corner]);
        vertex_of[corner] = uint32_t(mesh.vertices.size() - 1);
    }
    for (size_t c = 0; c + 2 < corners.size(); c += 3) {
        const TriangleMesh::Triangle t{vertex_of[c], vertex_of[c + 1], vertex_of[c + 2]};
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
    }
}

struct HalfEdge {
    uint32_t low, high;  // vertices
    bool is_forward;     // runs from low to high
    uint32_t triangle;
    uint8_t edge;  // from corner `edge` to the next

    bool sameEdge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<HalfEdge> sortedHalfEdges(const TriangleMesh& mesh) {
    std::vector<HalfEdge> half_edges;
    half_edges.reserve(3 * mesh.triangles.size());
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (uint8_t e = 0; e < 3; ++e) {
            const uint32_t a = mesh.triangles[t][e], b = mesh.triangles[t][(e + 1) % 3];
            half_edges.push_back({std::min(a, b), std::max(a, b), a < b, t, e});
        }
    std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle, a.edge) < std::tie(b.low, b.high, b.triangle, b.edge);
    });
    return half_edges;
}

// Fills neighbours, or says how the surface fails to be closed.
void connect(TriangleMesh& mesh, const std::string& file) {
    const std::vector<HalfEdge> half_edges = sortedHalfEdges(mesh);
    mesh.neighbours.resize(mesh.triangles.size());
    size_t open = 0, crowded = 0, turned = 0;
    for (size_t begin = 0, end; begin < half_edges.size(); begin = end) {
        for (end = begin + 1; end < half_edges.size() && half_edges[end].sameEdge(half_edges[begin]);) ++end;
        if (end - begin == 1) ++open;
        if (end - begin > 2) ++crowded;
        if (end - begin != 2) continue;
        const HalfEdge &a = half_edges[begin], &b = half_edges[begin + 1];
        if (a.is_forward == b.is_forward) ++turned;
        mesh.neighbours[a.triangle][a.edge] = b.triangle;
        mesh.neighbours[b.triangle][b.edge] = a.triangle;
    }
    if (open + crowded > 0)
        throw UserError(file + ": the surface is not closed: " + std::to_string(open) +
                        " edges have one triangle only and " + std::to_string(crowded) + " more than two (" +
                        std::to_string(mesh.triangles.size()) +
                        " triangles); "
                        "fill the holes and merge the parts into one solid, or if the file is cut short, "
                        "just export again");
    if (turned > 0)
        throw UserError(
            file + ": triangles face different ways: " + std::to_string(turned) +
            " edges lie between two of opposite orientation; recalculate the normals to point outwards");
}

double volumeOf(const TriangleMesh& mesh) {
    const Vector3d center = mesh.box().center();
    double volume = 0;
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        volume += (mesh.vertex(t, 0) - center).dot(mesh.areaNormal(t)) / 6;
    return volume;
}

void turn(TriangleMesh& mesh) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    for (auto& n : mesh.neighbours) std::swap(n[0], n[2]);
}

}  // namespace

Eigen::AlignedBox3d TriangleMesh::box() const {
    Eigen::AlignedBox3d box;
    for (const Vector3d& p : vertices) box.extend(p);
    return box;
}

Eigen::Vector3d TriangleMesh::areaNormal(uint32_t triangle) const {
    const Vector3d a = vertex(triangle, 0);
    return (vertex(triangle, 1) - a).cross(vertex(triangle, 2) - a);
}

TriangleMesh closedMesh(const std::vector<Vector3d>& corners, const std::string& file,
                        const SolidKind& kind) {
    checkCorners(corners, file, kind);
    TriangleMesh mesh;
    weld(corners, mesh);
    if (mesh.triangles.empty())
        throw UserError(file + ": every triangle has two equal corners; export the tool's surface again");
    connect(mesh, file);
    const double volume = volumeOf(mesh);
    if (volume == 0) throw UserError(file + ": the surface encloses no volume; export a solid");
    if (volume < 0) turn(mesh);
    return mesh;
}

}  // namespace bonemill

#include "haptic_server/scene/tool_build/surface.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "common/base/units.h"
#include "common/math/pinned_math.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr int kSegments = 48;      // around the axis
constexpr int kQuarterRings = 12;  // from a ball's pole to its equator
constexpr double kSmoothBend = 40 * kDegree;

// It is a ring of a solid of revolution: how far along and off the axis, and the normal there.
struct Ring {
    double along, off;
    double normal_along, normal_off;
};

void appendBand(TriangleSurface& surface, uint32_t base, int segment) {
    const auto a = base + uint32_t(segment), b = base + uint32_t((segment + 1) % kSegments);
    const uint32_t c = a + kSegments, d = b + kSegments;
    surface.indices.insert(surface.indices.end(), {a, b, c, b, d, c});
}

// Rings in order along the axis; one smooth piece of surface.
void revolve(const Vector3d& origin, const Vector3d& axis, const std::vector<Ring>& rings,
             TriangleSurface& surface) {
    const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
    for (size_t r = 0; r < rings.size(); ++r) {
        const auto base = uint32_t(surface.positions.size());
        for (int s = 0; s < kSegments; ++s) {
            const double angle = kTurn * s / kSegments;
            const Vector3d radial = pinned::cos(angle) * u + pinned::sin(angle) * v;
            const Ring& ring = rings[r];
            surface.positions.push_back((origin + ring.along * axis + ring.off * radial).cast<float>());
            surface.normals.push_back(
                (ring.normal_along * axis + ring.normal_off * radial).normalized().cast<float>());
            if (r + 1 < rings.size()) appendBand(surface, base, s);
        }
    }
}

// Half a ball from latitude `from` in quarter turns (-1: pole, 0: equator).
void appendQuarter(std::vector<Ring>& rings, double center, double radius, int from) {
    for (int i = 0; i <= kQuarterRings; ++i) {
        const double quarter_turns = from + double(i) / kQuarterRings;
        const double sine = pinned::sin(quarter_turns * std::numbers::pi / 2);
        const double cosine =
            pinned::sin((1 - std::abs(quarter_turns)) * std::numbers::pi / 2);  // exactly 0 at a pole
        rings.push_back({center + radius * sine, radius * cosine, sine, cosine});
    }
}

void append(const CapsuleShape& s, TriangleSurface& surface) {
    const double length = (s.to - s.from).norm();
    const Vector3d axis = length > 0 ? Vector3d((s.to - s.from) / length) : Vector3d::UnitY();
    std::vector<Ring> rings;
    appendQuarter(rings, 0, s.radius, -1);
    appendQuarter(rings, length, s.radius, 0);
    revolve(s.from, axis, rings, surface);
}

void append(const SphereShape& s, TriangleSurface& surface) {
    append(CapsuleShape{s.center, s.center, s.radius}, surface);
}

void append(const ConeShape& s, TriangleSurface& surface) {
    const double length = (s.to - s.from).norm();
    const Vector3d axis = (s.to - s.from) / length;
    const double slope = s.from_radius - s.to_radius;
    revolve(s.from, axis, {{0, 0, -1, 0}, {0, s.from_radius, -1, 0}}, surface);
    revolve(s.from, axis, {{0, s.from_radius, slope, length}, {length, s.to_radius, slope, length}}, surface);
    revolve(s.from, axis, {{length, s.to_radius, 1, 0}, {length, 0, 1, 0}}, surface);
}

void append(const CylinderShape& s, TriangleSurface& surface) {
    append(asCone(s), surface);
}

// Poles and apexes make triangles without area: nothing to draw.
void dropFlatTriangles(TriangleSurface& surface) {
    size_t kept = 0;
    for (size_t i = 0; i < surface.indices.size(); i += 3) {
        const auto p = [&](size_t c) { return surface.positions[surface.indices[i + c]]; };
        if (p(0) == p(1) || p(1) == p(2) || p(2) == p(0)) continue;
        for (size_t c = 0; c < 3; ++c) surface.indices[kept++] = surface.indices[i + c];
    }
    surface.indices.resize(kept);
}

// Corner c of triangle t is element 3t + c; corners that share a normal end up in one group.
class CornerGroups {
  public:
    explicit CornerGroups(size_t corners) : parent_(corners) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    uint32_t find(uint32_t corner) {
        while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
        return corner;
    }
    void join(uint32_t a, uint32_t b) { parent_[find(a)] = find(b); }

  private:
    std::vector<uint32_t> parent_;
};

uint32_t cornerAt(const TriangleMesh& mesh, uint32_t triangle, uint32_t vertex) {
    const auto& t = mesh.triangles[triangle];
    return 3 * triangle + (t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2);
}

CornerGroups groupAcrossSmoothEdges(const TriangleMesh& mesh, const std::vector<Vector3d>& unit_normals) {
    CornerGroups groups(3 * mesh.triangles.size());
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        for (int e = 0; e < 3; ++e) {
            const uint32_t neighbour = mesh.neighbours[t][e];
            if (unit_normals[t].dot(unit_normals[neighbour]) < pinned::cos(kSmoothBend)) continue;
            for (const uint32_t vertex : {mesh.triangles[t][e], mesh.triangles[t][(e + 1) % 3]})
                groups.join(cornerAt(mesh, t, vertex), cornerAt(mesh, neighbour, vertex));
        }
    return groups;
}

}  // namespace

TriangleSurface surfaceOf(const std::vector<ToolShape>& shapes) {
    TriangleSurface surface;
    for (const ToolShape& shape : shapes) std::visit([&](const auto& s) { append(s, surface); }, shape);
    dropFlatTriangles(surface);
    return surface;
}

TriangleSurface surfaceOf(const TriangleMesh& mesh) {
    std::vector<Vector3d> unit_normals(mesh.triangles.size());
    for (uint32_t t = 0; t < unit_normals.size(); ++t)
        unit_normals[t] = mesh.areaNormal(t).stableNormalized();
    CornerGroups groups = groupAcrossSmoothEdges(mesh, unit_normals);

    constexpr uint32_t kNone = UINT32_MAX;
    std::vector<uint32_t> position_of(3 * mesh.triangles.size(), kNone);
    std::vector<Vector3d> sums;
    TriangleSurface surface;
    for (uint32_t corner = 0; corner < position_of.size(); ++corner) {
        uint32_t& position = position_of[groups.find(corner)];
        if (position == kNone) {
            position = uint32_t(surface.positions.size());
            surface.positions.push_back(mesh.vertex(corner / 3, int(corner % 3)).cast<float>());
            sums.push_back(Vector3d::Zero());
        }
        sums[position] += mesh.areaNormal(corner / 3);
        surface.indices.push_back(position);
    }
    for (const Vector3d& sum : sums) surface.normals.push_back(sum.stableNormalized().cast<float>());
    return surface;
}

}  // namespace bonemill

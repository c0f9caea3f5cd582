// Reads the triangles of a mesh file, and makes of them a closed mesh: what is left once they are welded and
// found to bound a solid. It is for start-up only, since it allocates and throws.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/geometry/pose.h"

namespace bonemill {

// What a mesh file is read for.
struct SolidKind {
    const char* name;
    const char* extension[2];  // of its files
    double smallest, largest;  // m: limits of the longest side
};

// The smallest burr sold is about 0.5 mm thick, the longest drill about 300 mm long; what lies outside was
// most likely not saved in millimetres.
inline constexpr SolidKind kToolSolid{"tool", {"stl", "obj"}, 0.3e-3, 0.5};
// A stapes is 3 mm long, a man less than 2 m.
inline constexpr SolidKind kBoneSolid{"bone", {"stl", "ply"}, 1e-3, 2};

struct TriangleMesh {
    using Triangle = std::array<uint32_t, 3>;  // vertices, counter-clockwise seen from outside

    std::vector<Eigen::Vector3d> vertices;  // m
    std::vector<Triangle> triangles;
    std::vector<Triangle> neighbours;  // of each triangle, across its edge (corner e, corner e+1)

    Eigen::AlignedBox3d box() const;
    Eigen::Vector3d vertex(uint32_t triangle, int corner) const {
        return vertices[triangles[triangle][corner % 3]];
    }
    // Returns twice the triangle's area times its outward unit normal.
    Eigen::Vector3d areaNormal(uint32_t triangle) const;
};

// Welds identical corners (three per triangle, m), drops triangles that thereby lose a corner, turns an
// inside-out mesh. Throws UserError, naming `file` and what to do, unless the corners are finite, of the
// kind's size, and form a closed surface: every edge in exactly two triangles that run it in opposite
// directions.
TriangleMesh closedMesh(const std::vector<Eigen::Vector3d>& corners, const std::string& file,
                        const SolidKind& kind = kToolSolid);

// Three corners per triangle in m, from an .stl (binary or text), .obj or .ply file in mm; larger polygons
// are cut up, lines and points left out. Throws UserError, naming the file and what to do, if it cannot be
// read.
std::vector<Eigen::Vector3d> readMeshFile(const std::filesystem::path& path,
                                          const SolidKind& kind = kToolSolid);

}  // namespace bonemill

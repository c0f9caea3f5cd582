// Reads the triangles of a mesh file. It is for start-up only, since it allocates and throws.
#pragma once

#include <filesystem>
#include <vector>

#include "common/geometry/pose.h"
#include "haptic_server/scans/solid_mesh/triangle_mesh.h"

namespace bonemill {

// Three corners per triangle in m, from an .stl (binary or text), .obj or .ply file in mm; larger polygons
// are cut up, lines and points left out. Throws UserError, naming the file and what to do, if it cannot be
// read.
std::vector<Eigen::Vector3d> readMeshFile(const std::filesystem::path& path,
                                          const SolidKind& kind = kToolSolid);

}  // namespace bonemill

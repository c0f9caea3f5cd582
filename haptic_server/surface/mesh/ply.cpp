#include "haptic_server/surface/mesh/ply.h"

#include <bit>
#include <fstream>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "haptic_server/surface/mesh/append_bytes.h"
#include "haptic_server/surface/mesh/welded_mesh.h"

namespace bonemill {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says little endian");

constexpr uint8_t kCorners = 3;
constexpr size_t kVertexBytes = 6 * sizeof(float);
constexpr size_t kTriangleBytes = sizeof kCorners + 3 * sizeof(uint32_t);

std::string headerText(const WeldedMesh& mesh) {
    std::string text =
        "ply\nformat binary_little_endian 1.0\ncomment bonemill surface, mm, frame W (LPS)\nelement vertex " +
        std::to_string(mesh.vertices.size()) + "\n";
    for (const char* property : {"x", "y", "z", "nx", "ny", "nz"})
        text += std::string("property float ") + property + "\n";
    return text + "element face " + std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::vector<char> contentOf(const WeldedMesh& mesh, const MeshGrid& grid, const Pose& X_WV) {
    std::vector<char> out;
    out.reserve(mesh.vertices.size() * kVertexBytes + mesh.triangles.size() * kTriangleBytes);
    const Eigen::Quaternionf R_WV = X_WV.rotation.cast<float>();
    for (size_t n = 0; n < mesh.vertices.size(); ++n) {
        const Eigen::Vector3f p_mm = (X_WV * grid.position(mesh.vertices[n]) * kPerMillimetre).cast<float>();
        const Eigen::Vector3f normal = R_WV * mesh.normals[n];
        appendBytes(out, p_mm.data(), 3 * sizeof(float));
        appendBytes(out, normal.data(), 3 * sizeof(float));
    }
    for (const auto& triangle : mesh.triangles) {
        appendBytes(out, &kCorners, sizeof kCorners);
        appendBytes(out, triangle.data(), sizeof triangle);
    }
    return out;
}

}  // namespace

void savePly(const std::string& path, std::span<const NodeMesh> meshes, const MeshGrid& grid,
             const Pose& X_WV) {
    const WeldedMesh mesh = weld(meshes, grid);
    const std::string header = headerText(mesh);
    const std::vector<char> content = contentOf(mesh, grid, X_WV);
    std::ofstream file(path, std::ios::binary);
    file.write(header.data(), std::streamsize(header.size()));
    file.write(content.data(), std::streamsize(content.size()));
    file.close();
    if (!file)
        throw UserError("cannot write the mesh to '" + path +
                        "': is the folder there, writable and not full?");
}

}  // namespace bonemill

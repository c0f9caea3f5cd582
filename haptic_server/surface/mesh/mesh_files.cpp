#include "haptic_server/surface/mesh/mesh_files.h"

#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "haptic_server/surface/mesh/welded_mesh.h"

namespace bonemill {
namespace {

static_assert(std::endian::native == std::endian::little, "STL is little-endian, and the PLY header says so");

// Appends `size` bytes at `data`, as they lie in memory.
void appendBytes(std::vector<char>& out, const void* data, size_t size) {
    const char* bytes = static_cast<const char*>(data);
    out.insert(out.end(), bytes, bytes + size);
}

void write(const std::string& path, const std::vector<char>& out) {
    std::ofstream file(path, std::ios::binary);
    file.write(out.data(), std::streamsize(out.size()));
    file.close();
    if (!file)
        throw UserError("cannot write the mesh to '" + path +
                        "': is the folder there, writable and not full?");
}

constexpr size_t kHeaderBytes = 80;
constexpr size_t kRecordBytes = 50;  // normal and 3 points as float, 2 unused bytes

void appendTriangle(std::vector<char>& out, const std::array<Eigen::Vector3f, 3>& p_mm) {
    const Eigen::Vector3d side_a = (p_mm[1] - p_mm[0]).cast<double>();
    const Eigen::Vector3d side_b = (p_mm[2] - p_mm[0]).cast<double>();
    const Eigen::Vector3f normal = side_a.cross(side_b).normalized().cast<float>();
    appendBytes(out, normal.data(), sizeof(float) * 3);
    for (const Eigen::Vector3f& p : p_mm) appendBytes(out, p.data(), sizeof(float) * 3);
    out.insert(out.end(), 2, 0);
}

std::vector<Eigen::Vector3f> pointsInMm(const NodeMesh& mesh, const MeshGrid& grid, const Pose& X_WV) {
    std::vector<Eigen::Vector3f> points;
    points.reserve(mesh.vertices.size());
    for (const PackedVertex& vertex : mesh.vertices) {
        const Eigen::Vector3d p_W = X_WV * grid.position(grid.stepsOf(mesh.leaf, vertex));
        points.push_back((p_W * kPerMillimetre).cast<float>());
    }
    return points;
}

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

std::vector<char> plyOf(const WeldedMesh& mesh, const MeshGrid& grid, const Pose& X_WV) {
    const std::string header = headerText(mesh);
    std::vector<char> out;
    out.reserve(header.size() + mesh.vertices.size() * kVertexBytes + mesh.triangles.size() * kTriangleBytes);
    appendBytes(out, header.data(), header.size());
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

void saveStl(const std::string& path, std::span<const NodeMesh> meshes, const MeshGrid& grid,
             const Pose& X_WV) {
    size_t triangles = 0;
    for (const NodeMesh& mesh : meshes) triangles += mesh.indices.size() / 3;

    std::vector<char> out;
    out.reserve(kHeaderBytes + sizeof(uint32_t) + triangles * kRecordBytes);
    out.resize(kHeaderBytes, 0);
    constexpr char kTitle[] =
        "bonemill surface, mm, frame W (LPS)";  // must not begin with "solid": that is text STL
    std::memcpy(out.data(), kTitle, sizeof kTitle - 1);
    const auto count = uint32_t(triangles);
    appendBytes(out, &count, sizeof count);
    for (const NodeMesh& mesh : meshes) {
        const std::vector<Eigen::Vector3f> p = pointsInMm(mesh, grid, X_WV);
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
            appendTriangle(out, {p[mesh.indices[i]], p[mesh.indices[i + 1]], p[mesh.indices[i + 2]]});
    }
    write(path, out);
}

void savePly(const std::string& path, std::span<const NodeMesh> meshes, const MeshGrid& grid,
             const Pose& X_WV) {
    write(path, plyOf(weld(meshes, grid), grid, X_WV));
}

}  // namespace bonemill

#include "haptic_server/surface/mesh/stl.h"

#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "haptic_server/surface/mesh/append_bytes.h"

namespace bonemill {
namespace {

static_assert(std::endian::native == std::endian::little, "STL is little-endian");

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

    std::ofstream file(path, std::ios::binary);
    file.write(out.data(), std::streamsize(out.size()));
    file.close();
    if (!file)
        throw UserError("cannot write the mesh to '" + path +
                        "': is the folder there, writable and not full?");
}

}  // namespace bonemill

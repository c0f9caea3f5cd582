#include "haptic_server/scans/solid_mesh/mesh_file.h"

#include <assimp/BaseImporter.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <numeric>
#include <sstream>
#include <string_view>
#include <tuple>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

std::string inMillimetres(double metres) {
    return printed("%.4g mm", metres * kPerMillimetre);
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

constexpr double kMetresPerFileUnit = kMillimetre;
constexpr uintmax_t kMaxFile = uintmax_t(512) << 20;  // 10 million binary STL triangles

constexpr size_t kStlHeader = 80;
constexpr size_t kStlTriangle = 50;

std::string lowerExtension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension.empty() ? extension : extension.substr(1);
}

std::string filesOf(const SolidKind& kind) {
    return std::string("an .") + kind.extension[0] + " or ." + kind.extension[1] + " file";
}

std::string readBytes(const std::filesystem::path& path, const SolidKind& kind) {
    const std::string name = path.string();
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw UserError(name + ": there is no such mesh file; check the path of the " + kind.name);
    if (!std::filesystem::is_regular_file(path, error))
        throw UserError(name + ": not a file; name " + filesOf(kind));
    const uintmax_t size = std::filesystem::file_size(path, error);
    if (error || size > kMaxFile)
        throw UserError(name + ": too large for a " + kind.name + "; simplify the mesh below 512 MiB");
    if (size == 0) throw UserError(name + ": the file is empty; export the " + kind.name + "'s mesh again");
    std::string bytes(size, '\0');
    std::ifstream file(path, std::ios::binary);
    if (!file.read(bytes.data(), std::streamsize(size)))
        throw UserError(name + ": cannot be read; check its permissions");
    return bytes;
}

// Binary STL may start with "solid" too: then its length still tells.
bool isTextStl(std::string_view bytes) {
    return bytes.substr(0, 5) == "solid" && bytes.substr(0, 4096).find('\0') == std::string_view::npos;
}

// A binary STL says how long it must be; the loader's own check knows nothing better to say
// than "cannot determine".
void checkBinaryStl(std::string_view bytes, const std::string& name) {
    if (bytes.size() < kStlHeader + sizeof(uint32_t))
        throw UserError(name +
                        ": not an STL file: neither text starting with \"solid\" nor long enough for binary");
    uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kStlHeader, sizeof count);
    const uint64_t needed = kStlHeader + sizeof count + uint64_t(count) * kStlTriangle;
    if (needed != bytes.size())
        throw UserError(name + ": damaged or not an STL file: its header announces " + std::to_string(count) +
                        " triangles, which take " + std::to_string(needed) + " bytes, but it has " +
                        std::to_string(bytes.size()) + "; export it again");
    if (count == 0) throw UserError(name + ": holds no triangles; export the surface as triangles");
}

// The loader goes on for ever where a header does not end, and believes any number of elements.
void checkPly(std::string_view bytes, const std::string& name) {
    constexpr size_t kLongestHeader = 1 << 16;
    constexpr std::string_view kEnd = "\nend_header";
    const size_t end = bytes.substr(0, kLongestHeader).find(kEnd);
    const bool is_line = end != std::string_view::npos && end + kEnd.size() < bytes.size() &&
                         std::string_view("\r\n").find(bytes[end + kEnd.size()]) != std::string_view::npos;
    if (!bytes.starts_with("ply") || !is_line)
        throw UserError(name +
                        ": not a PLY file, or cut short: its header does not start with \"ply\" and end "
                        "with the line \"end_header\"; export it again");
    std::istringstream lines{std::string(bytes.substr(0, end))};
    const auto left = double(bytes.size() - end - kEnd.size());
    double elements = 0;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string word, kind, count;
        if (!(words >> word >> kind >> count) || word != "element") continue;
        const double number = std::strtod(count.c_str(), nullptr);
        elements += number >= 0 ? number : left + 1;
    }
    if (!(elements <= left))  // a byte each at least
        throw UserError(name +
                        ": damaged: its header announces more vertices and faces than the file can hold; "
                        "export it again");
}

// Content must not choose one of the library's fifty other loaders.
void keepOnlyLoader(Assimp::Importer& importer, const std::string& extension) {
    for (size_t i = importer.GetImporterCount(); i-- > 0;) {
        Assimp::BaseImporter* loader = importer.GetImporter(i);
        const std::string_view extensions = loader->GetInfo()->mFileExtensions;
        if (extensions == extension) continue;
        importer.UnregisterLoader(loader);
        delete loader;  // unregistering passes the ownership on
    }
}

// The time that the library takes to cut up a face grows with the square of its corners, or faster.
void checkFaces(const aiScene& scene, const std::string& name) {
    constexpr unsigned kMaxCorners = 1000;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        for (unsigned f = 0; f < scene.mMeshes[m]->mNumFaces; ++f)
            if (const unsigned corners = scene.mMeshes[m]->mFaces[f].mNumIndices; corners > kMaxCorners)
                throw UserError(name + ": has a face of " + std::to_string(corners) + " corners, more than " +
                                std::to_string(kMaxCorners) + "; export the surface as triangles");
}

std::vector<Eigen::Vector3d> cornersOf(const aiScene& scene) {
    std::vector<Eigen::Vector3d> corners;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices != 3) continue;
            for (int c = 0; c < 3; ++c) {
                const aiVector3D& v = mesh.mVertices[face.mIndices[c]];
                corners.push_back(kMetresPerFileUnit * Eigen::Vector3d(v.x, v.y, v.z));
            }
        }
    }
    return corners;
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

std::vector<Eigen::Vector3d> readMeshFile(const std::filesystem::path& path, const SolidKind& kind) {
    const std::string name = path.string();
    const std::string extension = lowerExtension(path);
    if (extension != kind.extension[0] && extension != kind.extension[1])
        throw UserError(name + ": a " + kind.name + "'s mesh is " + filesOf(kind) +
                        "; convert it to one of them");
    const std::string bytes = readBytes(path, kind);
    if (extension == "stl" && !isTextStl(bytes)) checkBinaryStl(bytes, name);

    if (extension == "ply") checkPly(bytes, name);
    Assimp::Importer importer;
    keepOnlyLoader(importer, extension);
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, extension.c_str());
    if (scene != nullptr) {
        checkFaces(*scene, name);
        scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    }
    if (scene == nullptr)
        throw UserError(name + ": cannot be read as ." + extension + ": " + importer.GetErrorString() +
                        "; export the mesh again");
    return cornersOf(*scene);
}

}  // namespace bonemill

// Reads a binary PLY file of triangles with normals, as any other program would.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace bonemill::test {

struct PlyMesh {
    std::vector<Eigen::Vector3f> points, normals;
    std::vector<std::array<uint32_t, 3>> triangles;

    // Every edge joins two triangles that run along it in opposite directions.
    bool isClosed() const {
        std::map<std::pair<uint32_t, uint32_t>, int> balance, uses;
        for (const auto& t : triangles)
            for (size_t corner = 0; corner < 3; ++corner) {
                const uint32_t a = t[corner], b = t[(corner + 1) % 3];
                const auto edge = std::minmax(a, b);
                balance[edge] += a < b ? 1 : -1;
                ++uses[edge];
            }
        for (const auto& [edge, sum] : balance)
            if (sum != 0 || uses[edge] != 2) return false;
        return !triangles.empty();
    }
    double volume() const {
        double six_volumes = 0;
        for (const auto& t : triangles)
            six_volumes += points[t[0]].cast<double>().dot(
                points[t[1]].cast<double>().cross(points[t[2]].cast<double>()));
        return six_volumes / 6;
    }
};

// The mesh is empty if the header is not the documented one, or the size not what it says.
inline PlyMesh readPly(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream content;
    content << file.rdbuf();
    const std::string bytes = content.str();
    const std::string end = "end_header\n";
    const size_t data = bytes.find(end) + end.size();
    std::istringstream header(bytes.substr(0, data));
    size_t vertices = 0, faces = 0;
    std::string properties;
    for (std::string line; std::getline(header, line);) {
        std::istringstream words(line);
        std::string first, second;
        words >> first >> second;
        if (first == "element") words >> (second == "vertex" ? vertices : faces);
        if (first == "property" || first == "format") properties += line + ";";
    }
    PlyMesh mesh;
    if (properties !=
            "format binary_little_endian 1.0;property float x;property float y;property float z;"
            "property float nx;property float ny;property float nz;"
            "property list uchar int vertex_indices;" ||
        bytes.size() != data + vertices * 24 + faces * 13)
        return mesh;
    for (size_t n = 0; n < vertices; ++n) {
        std::array<float, 6> v;
        std::memcpy(v.data(), bytes.data() + data + n * 24, 24);
        mesh.points.push_back({v[0], v[1], v[2]});
        mesh.normals.push_back({v[3], v[4], v[5]});
    }
    for (size_t n = 0; n < faces; ++n) {
        const char* face = bytes.data() + data + vertices * 24 + n * 13;
        std::array<uint32_t, 3> t;
        std::memcpy(t.data(), face + 1, 12);
        if (*face == 3) mesh.triangles.push_back(t);
    }
    return mesh;
}

}  // namespace bonemill::test

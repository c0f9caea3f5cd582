// Makes triangle soups for tests, and mesh files of them: binary and text STL, OBJ. Coordinates are the
// file's (mm).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace bonemill::test {

using SoupTriangle = std::array<Eigen::Vector3f, 3>;  // counter-clockwise seen from outside
using TriangleSoup = std::vector<SoupTriangle>;

inline void addQuad(TriangleSoup& soup, const std::array<Eigen::Vector3f, 4>& q) {
    soup.push_back({q[0], q[1], q[2]});
    soup.push_back({q[0], q[2], q[3]});
}

// Pulls a polygon (counter-clockwise in x, y; fanned from its first corner) from low to high along z.
inline TriangleSoup prism(const std::vector<Eigen::Vector2f>& polygon, float low, float high) {
    TriangleSoup soup;
    const auto at = [&](size_t i, float z) {
        const Eigen::Vector2f& p = polygon[i % polygon.size()];
        return Eigen::Vector3f(p.x(), p.y(), z);
    };
    for (size_t i = 0; i < polygon.size(); ++i)
        addQuad(soup, {at(i, low), at(i + 1, low), at(i + 1, high), at(i, high)});
    for (size_t i = 1; i + 1 < polygon.size(); ++i) {
        soup.push_back({at(0, high), at(i, high), at(i + 1, high)});
        soup.push_back({at(0, low), at(i + 1, low), at(i, low)});
    }
    return soup;
}

inline TriangleSoup boxSoup(const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
    return prism({{low.x(), low.y()}, {high.x(), low.y()}, {high.x(), high.y()}, {low.x(), high.y()}},
                 low.z(), high.z());
}

// Makes a ball around `center` whose radius depends on the direction (unit vector), of 2·rings·(rings -
// 1)·2 triangles.
inline TriangleSoup ballSoup(int rings, const Eigen::Vector3f& center,
                             const std::function<double(const Eigen::Vector3d&)>& radius) {
    const int segments = 2 * rings;
    const auto at = [&](int ring, int segment) -> Eigen::Vector3f {
        const double polar = std::numbers::pi * ring / rings;
        const double azimuth = 2 * std::numbers::pi * (segment % segments) / segments;
        Eigen::Vector3d direction(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                  std::cos(polar));
        if (ring == 0 || ring == rings) direction = Eigen::Vector3d(0, 0, ring == 0 ? 1 : -1);
        return center + (radius(direction) * direction).cast<float>();
    };
    TriangleSoup soup;
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < segments; ++s) {
            if (r + 1 < rings) soup.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
            if (r > 0) soup.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
        }
    return soup;
}

inline std::string binaryStl(const TriangleSoup& soup) {
    std::string bytes(80, ' ');
    const auto append = [&](const void* data, size_t size) {
        bytes.append(static_cast<const char*>(data), size);
    };
    const auto count = uint32_t(soup.size());
    append(&count, sizeof count);
    const float no_normal[3] = {0, 0, 0};
    const uint16_t attribute = 0;
    for (const SoupTriangle& t : soup) {
        append(no_normal, sizeof no_normal);
        for (const Eigen::Vector3f& p : t) append(p.data(), 3 * sizeof(float));
        append(&attribute, sizeof attribute);
    }
    return bytes;
}

inline std::string textStl(const TriangleSoup& soup) {
    std::ostringstream out;
    out.precision(9);
    out << "solid tool\n";
    for (const SoupTriangle& t : soup) {
        out << "facet normal 0 0 0\n outer loop\n";
        for (const Eigen::Vector3f& p : t)
            out << "  vertex " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
        out << " endloop\nendfacet\n";
    }
    out << "endsolid tool\n";
    return out.str();
}

inline std::string obj(const TriangleSoup& soup) {
    std::ostringstream out;
    out.precision(9);
    for (const SoupTriangle& t : soup)
        for (const Eigen::Vector3f& p : t) out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    for (size_t i = 0; i < soup.size(); ++i)
        out << "f " << 3 * i + 1 << ' ' << 3 * i + 2 << ' ' << 3 * i + 3 << '\n';
    return out.str();
}

inline void writeBytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

}  // namespace bonemill::test

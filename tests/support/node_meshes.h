// Makes node meshes for tests of what carries them, and compares them up to the order of vertices
// and triangles.
#pragma once

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "common/geometry/node_mesh.h"

namespace bonemill::test {

// Makes a wavy sheet of side × side squares with random normals; it has many shared vertices, as a real
// leaf has.
inline NodeMesh sheetMesh(int side, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> height(1, 4000), normal(-127, 127);
    NodeMesh mesh;
    mesh.leaf = seed;
    mesh.revision = 2 * seed;
    mesh.origin = {0.01f, -0.02f, 0.03f};
    mesh.step = {1e-7f, 2e-7f, 3e-7f};
    for (int y = 0; y <= side; ++y)
        for (int x = 0; x <= side; ++x)
            mesh.vertices.push_back({uint16_t(x * 60000 / (side + 1)), uint16_t(y * 60000 / (side + 1)),
                                     uint16_t(height(random)), int8_t(normal(random)),
                                     int8_t(normal(random))});
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto a = uint32_t(x + y * (side + 1));
            const auto b = uint32_t(a + uint32_t(side) + 1);
            for (const uint32_t index : {a, a + 1, b, b, a + 1, b + 1}) mesh.indices.push_back(index);
        }
    return mesh;
}

// It is like that sheet, with patches of materials.
inline NodeMesh colouredSheetMesh(int side, unsigned seed) {
    NodeMesh mesh = sheetMesh(side, seed);
    for (size_t n = 0; n < mesh.vertices.size(); ++n)
        mesh.materials.push_back(uint8_t((n / 3 + seed) % 5 * 60));
    return mesh;
}

// Each key begins at its triangle's smallest corner (winding kept) and is the vertices' values; the
// keys are sorted.
using TriangleKey = std::array<std::array<int, 6>, 3>;
inline std::vector<TriangleKey> triangleKeys(const NodeMesh& mesh) {
    std::vector<TriangleKey> keys;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        TriangleKey key;
        for (size_t corner = 0; corner < 3; ++corner) {
            const uint32_t index = mesh.indices[i + corner];
            const PackedVertex& v = mesh.vertices[index];
            const int material = mesh.materials.empty() ? 0 : mesh.materials[index];
            key[corner] = {v.x, v.y, v.z, v.octahedral_u, v.octahedral_v, material};
        }
        std::rotate(key.begin(), std::min_element(key.begin(), key.end()), key.end());
        keys.push_back(key);
    }
    std::sort(keys.begin(), keys.end());
    return keys;
}

}  // namespace bonemill::test

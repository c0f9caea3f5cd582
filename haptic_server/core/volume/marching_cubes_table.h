// The table says which triangles separate the corners of one cell that are inside the bone
// from those outside.
//
// The method is marching cubes (Lorensen and Cline 1987) with tables traced by our own code. On each face of
// the cell the crossed edges are joined by segments; the segments of a cell form closed loops; each loop is
// cut into triangles.
// - A face with two diagonal inside corners is ambiguous: its inside corners are always cut off one by one.
//   The rule sees only the face, so two cells that share it agree and the surface has no holes.
// - No diagonal of a triangulation lies in a face, so an edge of the surface never has more than two
//   triangles.
//
// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e runs along axis e / 4; see kCubeEdges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace bonemill {

struct CubeEdge {
    uint8_t low_corner;
    uint8_t axis;  // the edge's other corner is low_corner | 1 << axis
};

// Edges 4 a .. 4 a + 3 run along axis a; their low corners ascend.
inline constexpr std::array<CubeEdge, 12> kCubeEdges = {
    {{0, 0}, {2, 0}, {4, 0}, {6, 0}, {0, 1}, {1, 1}, {4, 1}, {5, 1}, {0, 2}, {1, 2}, {2, 2}, {3, 2}}};

inline constexpr int kMaxCubeTriangles = 5;

// Each triangle names three crossed edges, counter-clockwise seen from outside the bone.
struct CubeTriangles {
    uint8_t count = 0;
    std::array<std::array<uint8_t, 3>, kMaxCubeTriangles> edges{};
};

// Do these two edges of the cube border the same face?
bool shareCubeFace(int edge_a, int edge_b) noexcept;

// Indexed by the set of inside corners (bit c: corner c is inside). Built at the first call; thread-safe.
const std::array<CubeTriangles, 256>& cubeTriangles();

// The same as the kernels want it (kernels/kernels.h): kTrianglesPerCell numbers for each set, one per
// triangle, its edges in four bits each; 0: there is none. It allocates.
std::vector<int> packedCubeTriangles();

}  // namespace bonemill

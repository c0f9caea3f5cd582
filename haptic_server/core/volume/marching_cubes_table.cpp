#include "haptic_server/core/volume/marching_cubes_table.h"

#include <stdexcept>

#include "haptic_server/core/kernels/kernels.h"

namespace bonemill {
namespace {

using Loop = std::vector<uint8_t>;  // crossed edges in order
constexpr int kNotCrossed = -1;

bool isInside(int config, int corner) {
    return (config >> corner & 1) != 0;
}

int edgeBetween(int corner_a, int corner_b) {
    for (int e = 0; e < 12; ++e) {
        const int low = kCubeEdges[e].low_corner;
        const int high = low | 1 << kCubeEdges[e].axis;
        if ((corner_a == low && corner_b == high) || (corner_a == high && corner_b == low)) return e;
    }
    throw std::logic_error("corners without a common edge");
}

// These are the corners of a face, counter-clockwise as seen from outside the cell.
std::array<int, 4> faceCorners(int axis, int side) {
    const int u = 1 << (axis + 1) % 3;
    const int v = 1 << (axis + 2) % 3;
    const int base = side << axis;
    if (side == 1) return {base, base | u, base | u | v, base | v};
    return {base, base | v, base | u | v, base | u};
}

// Adds the segments of one face: going round it, where the walk enters the inside the surface's loop goes on
// to where that same inside run ends, so each run of inside corners is cut off by itself.
void addFaceSegments(int config, const std::array<int, 4>& corners, std::array<int, 12>& next) {
    for (int i = 0; i < 4; ++i) {
        if (isInside(config, corners[i]) || !isInside(config, corners[(i + 1) % 4])) continue;
        int last = (i + 1) % 4;
        while (isInside(config, corners[(last + 1) % 4])) last = (last + 1) % 4;
        next[edgeBetween(corners[i], corners[(i + 1) % 4])] =
            edgeBetween(corners[last], corners[(last + 1) % 4]);
    }
}

std::vector<Loop> traceLoops(int config) {
    std::array<int, 12> next;
    next.fill(kNotCrossed);
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) addFaceSegments(config, faceCorners(axis, side), next);

    std::vector<Loop> loops;
    for (int start = 0; start < 12; ++start) {
        Loop loop;
        for (int edge = start; next[edge] != kNotCrossed;) {
            loop.push_back(uint8_t(edge));
            const int following = next[edge];
            next[edge] = kNotCrossed;
            edge = following;
        }
        if (!loop.empty()) loops.push_back(loop);
    }
    return loops;
}

// Triangulates loop[first .. last], whose closing edge first-last is allowed; false (and nothing added) when
// every way to do so needs a diagonal in a face.
bool triangulate(const Loop& loop, size_t first, size_t last, CubeTriangles& out) {
    if (last - first < 2) return true;
    for (size_t apex = first + 1; apex < last; ++apex) {
        if (apex > first + 1 && shareCubeFace(loop[first], loop[apex])) continue;
        if (apex + 1 < last && shareCubeFace(loop[apex], loop[last])) continue;
        const CubeTriangles before = out;
        out.edges.at(out.count++) = {loop[first], loop[apex], loop[last]};
        if (triangulate(loop, first, apex, out) && triangulate(loop, apex, last, out)) return true;
        out = before;
    }
    return false;
}

std::array<CubeTriangles, 256> buildTable() {
    std::array<CubeTriangles, 256> table;
    for (int config = 0; config < 256; ++config)
        for (const Loop& loop : traceLoops(config))
            if (!triangulate(loop, 0, loop.size() - 1, table[config]))
                throw std::logic_error("marching cubes loop without a triangulation");
    return table;
}

}  // namespace

bool shareCubeFace(int edge_a, int edge_b) noexcept {
    const CubeEdge a = kCubeEdges[edge_a];
    const CubeEdge b = kCubeEdges[edge_b];
    for (int axis = 0; axis < 3; ++axis) {
        const bool both_beside = a.axis != axis && b.axis != axis;
        if (both_beside && ((a.low_corner ^ b.low_corner) >> axis & 1) == 0) return true;
    }
    return false;
}

const std::array<CubeTriangles, 256>& cubeTriangles() {
    static const std::array<CubeTriangles, 256> kTable = buildTable();
    return kTable;
}

std::vector<int> packedCubeTriangles() {
    static_assert(kMaxCubeTriangles == kTrianglesPerCell);
    std::vector<int> packed(256 * kTrianglesPerCell, 0);
    for (size_t inside = 0; inside < 256; ++inside) {
        const CubeTriangles& triangles = cubeTriangles()[inside];
        for (size_t n = 0; n < triangles.count; ++n) {
            const auto& [a, b, c] = triangles.edges[n];
            packed[inside * kTrianglesPerCell + n] = a | b << 4 | c << 8;
        }
    }
    return packed;
}

}  // namespace bonemill

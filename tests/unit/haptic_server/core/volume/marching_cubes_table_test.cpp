#include "haptic_server/core/volume/marching_cubes_table.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace bonemill {
namespace {

using Segment = std::pair<int, int>;  // directed, between crossed edges

int highCorner(int edge) {
    return kCubeEdges[edge].low_corner | 1 << kCubeEdges[edge].axis;
}
bool isInside(int config, int corner) {
    return (config >> corner & 1) != 0;
}

bool liesInFace(int edge, int axis, int side) {
    return kCubeEdges[edge].axis != axis && (kCubeEdges[edge].low_corner >> axis & 1) == side;
}

Eigen::Vector3d cornerPosition(int corner) {
    return {double(corner & 1), double(corner >> 1 & 1), double(corner >> 2 & 1)};
}
Eigen::Vector3d middle(int edge) {
    return (cornerPosition(kCubeEdges[edge].low_corner) + cornerPosition(highCorner(edge))) / 2;
}

std::multiset<Segment> triangleSides(int config) {
    std::multiset<Segment> sides;
    const CubeTriangles& triangles = cubeTriangles()[config];
    for (int t = 0; t < triangles.count; ++t)
        for (int corner = 0; corner < 3; ++corner)
            sides.insert({triangles.edges[t][corner], triangles.edges[t][(corner + 1) % 3]});
    return sides;
}

// Sides without a partner that runs back are the rim of the surface, which the neighbouring
// cells must continue.
std::set<Segment> rim(int config) {
    std::set<Segment> result;
    const auto sides = triangleSides(config);
    for (const Segment& s : sides)
        if (!sides.contains({s.second, s.first})) result.insert(s);
    return result;
}

std::set<Segment> rimInFace(int config, int axis, int side) {
    std::set<Segment> result;
    for (const Segment& s : rim(config))
        if (liesInFace(s.first, axis, side) && liesInFace(s.second, axis, side)) result.insert(s);
    return result;
}

// Returns the same edge of the neighbour beyond the high face.
int seenFromNeighbour(int edge, int axis) {
    const int low_corner = kCubeEdges[edge].low_corner & ~(1 << axis);
    for (int e = 0; e < 12; ++e)
        if (kCubeEdges[e].axis == kCubeEdges[edge].axis && kCubeEdges[e].low_corner == low_corner) return e;
    return -1;
}

int faceBits(int config, int axis, int side) {
    int bits = 0;
    for (int corner = 0, n = 0; corner < 8; ++corner)
        if ((corner >> axis & 1) == side) bits |= int(isInside(config, corner)) << n++;
    return bits;
}

TEST(MarchingCubesTable, EdgesAreTheTwelveOfTheCube) {
    std::set<std::pair<int, int>> edges;
    for (int e = 0; e < 12; ++e) {
        EXPECT_EQ(kCubeEdges[e].axis, e / 4);
        EXPECT_EQ(kCubeEdges[e].low_corner >> kCubeEdges[e].axis & 1, 0);
        edges.insert({kCubeEdges[e].low_corner, highCorner(e)});
    }
    EXPECT_EQ(edges.size(), 12u);
}

TEST(MarchingCubesTable, UsesExactlyTheCrossedEdges) {
    for (int config = 0; config < 256; ++config) {
        std::set<int> used, crossed;
        for (const Segment& s : triangleSides(config)) used.insert(s.first);
        for (int e = 0; e < 12; ++e)
            if (isInside(config, kCubeEdges[e].low_corner) != isInside(config, highCorner(e)))
                crossed.insert(e);
        EXPECT_EQ(used, crossed) << "configuration " << config;
    }
}

TEST(MarchingCubesTable, SidesAreEitherInnerDiagonalsOrFaceSegments) {
    for (int config = 0; config < 256; ++config) {
        const auto sides = triangleSides(config);
        for (const Segment& s : sides) {
            EXPECT_EQ(sides.count(s), 1u) << "configuration " << config;
            const bool is_diagonal = sides.contains({s.second, s.first});
            EXPECT_NE(shareCubeFace(s.first, s.second), is_diagonal) << "configuration " << config;
        }
    }
}

TEST(MarchingCubesTable, FaceSegmentsKeepTheBoneOnTheirRight) {
    size_t seen = 0;
    for (int config = 0; config < 256; ++config)
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side)
                for (const auto& [from, to] : rimInFace(config, axis, side)) {
                    const Eigen::Vector3d face_normal = (side == 1 ? 1 : -1) * Eigen::Vector3d::Unit(axis);
                    const Eigen::Vector3d left = face_normal.cross(middle(to) - middle(from));
                    for (const int edge : {from, to}) {
                        const int low = kCubeEdges[edge].low_corner;
                        const int bone = isInside(config, low) ? low : highCorner(edge);
                        EXPECT_LT((cornerPosition(bone) - middle(edge)).dot(left), 0)
                            << "configuration " << config;
                    }
                    ++seen;
                }
    EXPECT_GT(seen, 1000u);
}

// With the three tests above: each rim segment meets exactly one partner across its face, so every edge of a
// surface of any number of cells has exactly two triangles.
TEST(MarchingCubesTable, AllNeighboursAgreeOnTheirCommonFace) {
    size_t pairs = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (int here = 0; here < 256; ++here)
            for (int beyond = 0; beyond < 256; ++beyond) {
                if (faceBits(here, axis, 1) != faceBits(beyond, axis, 0)) continue;
                std::set<Segment> expected;
                for (const auto& [from, to] : rimInFace(here, axis, 1))
                    expected.insert({seenFromNeighbour(to, axis), seenFromNeighbour(from, axis)});
                EXPECT_EQ(rimInFace(beyond, axis, 0), expected)
                    << here << " beside " << beyond << ", axis " << axis;
                ++pairs;
            }
    EXPECT_EQ(pairs, 3u * 256 * 16);
}

TEST(MarchingCubesTable, EveryRimSegmentLiesInOneFace) {
    for (int config = 0; config < 256; ++config) {
        size_t in_faces = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) in_faces += rimInFace(config, axis, side).size();
        EXPECT_EQ(in_faces, rim(config).size());
    }
}

TEST(MarchingCubesTable, OneCornerGivesATriangleFacingAway) {
    for (int corner = 0; corner < 8; ++corner) {
        const CubeTriangles& triangles = cubeTriangles()[1 << corner];
        ASSERT_EQ(triangles.count, 1);
        const Eigen::Vector3d a = middle(triangles.edges[0][0]);
        const Eigen::Vector3d normal =
            (middle(triangles.edges[0][1]) - a).cross(middle(triangles.edges[0][2]) - a);
        EXPECT_GT(normal.dot(a - cornerPosition(corner)), 0);
    }
}

TEST(MarchingCubesTable, AmbiguousFaceCutsOffEachBoneCorner) {
    const int diagonal_corners = 1 << 0 | 1 << 3;  // on the face z = 0
    EXPECT_EQ(cubeTriangles()[diagonal_corners].count, 2);
    EXPECT_EQ(rimInFace(diagonal_corners, 2, 0).size(), 2u);
}

}  // namespace
}  // namespace bonemill

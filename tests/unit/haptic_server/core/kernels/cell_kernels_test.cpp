// Kernels that work on cells of the surface and on pieces of it: every instruction set gives the bits of the
// baseline, and the baseline is right.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/marching_cubes_table.h"
#include "tests/unit/haptic_server/core/kernels/every_level.h"

namespace bonemill {
namespace {

using test::expectSameBits;

class CellKernels : public test::EveryLevel {};

// The cells have random densities; tested are their patches, and the patches' centroids moved
// onto the surface.
struct CellCase {
    int count;
    std::vector<float> excess[8];
    std::vector<int> inside;
    CellArrays arrays() const {
        CellArrays a{{}, inside.data(), count};
        for (int c = 0; c < 8; ++c) a.excess[c] = excess[c].data();
        return a;
    }
};

double densityAt(const CellCase& cells, size_t n, double x, double y, double z) {
    double sum = 0;
    for (int c = 0; c < 8; ++c)
        sum += double(cells.excess[c][n]) * (c & 1 ? x : 1 - x) * (c & 2 ? y : 1 - y) * (c & 4 ? z : 1 - z);
    return sum;
}

TEST_P(CellKernels, CellPatchesAndProjections) {
    // Only one triangle is known here, cut off one corner: what marching cubes draws is tested elsewhere.
    std::vector<int> triangles(256 * kTrianglesPerCell, 0);
    for (int inside = 0; inside < 256; ++inside)
        triangles[size_t(inside) * kTrianglesPerCell] = 0 | 4 << 4 | 8 << 8;
    const float steps[3] = {1, 0.8f, 0.5f}, steepness[3] = {1, 1.5625f, 4}, inverse[3] = {1e3f, 1250, 2e3f};
    for (int round = 0; round < 50; ++round) {
        CellCase cells{1 + below(70), {}, {}};
        const size_t room = size_t(cells.count) + kCellLanes;
        cells.inside.assign(room, 1);
        for (int c = 0; c < 8; ++c)
            cells.excess[c] = randoms<float>(int(room), c == 0 ? 1 : -30000, c == 0 ? 30000 : -1);
        std::vector<float> patch[2][4], to[2][6];
        std::vector<int> found[2];
        for (const int which : {0, 1}) {
            const Kernels& k = which ? ours() : oracle();
            for (auto& v : patch[which]) v.resize(room);
            for (auto& v : to[which]) v.resize(room);
            found[which].resize(room);
            auto& p = patch[which];
            k.cell_patches(cells.arrays(), triangles.data(), steps,
                           {p[0].data(), p[1].data(), p[2].data(), p[3].data()});
            auto& t = to[which];
            for (size_t axis = 0; axis < 3; ++axis) t[axis] = p[axis + 1];
            k.project_into_cells(cells.arrays(), steepness, inverse, 1e-3f, 6,
                                 {t[0].data(), t[1].data(), t[2].data(), t[3].data(), t[4].data(),
                                  t[5].data(), found[which].data()});
        }
        for (int part = 0; part < 4; ++part) expectSameBits(patch[0][part], patch[1][part], cells.count);
        for (int part = 0; part < 6; ++part) expectSameBits(to[0][part], to[1][part], cells.count);
        expectSameBits(found[0], found[1], cells.count);
        for (size_t n = 0; n < size_t(cells.count); ++n) {
            double cut[3], largest = 0;  // how far along x, y and z the surface cuts the corner off
            for (int axis = 0; axis < 3; ++axis)
                cut[axis] = cells.excess[0][n] / double(cells.excess[0][n] - cells.excess[1 << axis][n]);
            for (int c = 0; c < 8; ++c) largest = std::max(largest, std::abs(double(cells.excess[c][n])));
            const double ax = cut[0] * 1, ay = cut[1] * 0.8, az = cut[2] * 0.5;
            EXPECT_NEAR(patch[0][0][n], std::hypot(ay * az, az * ax, ax * ay) / 2, 1e-5);
            for (size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(patch[0][axis + 1][n], cut[axis] / 3, 1e-4);
            if (!found[0][n]) continue;
            EXPECT_LE(std::abs(densityAt(cells, n, to[0][0][n], to[0][1][n], to[0][2][n])),
                      1.01e-3 * largest);
            EXPECT_NEAR(std::hypot(to[0][3][n], to[0][4][n], to[0][5][n]), 1, 1e-5);
        }
    }
}

TEST_P(CellKernels, PackedPointsAreThoseWithAnArea) {
    constexpr int kBits = 10;
    const float spacing[3] = {1e-4f, 3e-4f, 0.7e-4f}, unit = 9e-8f;
    for (int round = 0; round < 50; ++round) {
        const int count = below(70), room = count + kCellLanes;
        std::vector<int> index[3];
        for (auto& v : index) {
            v.resize(size_t(room));
            for (int& i : v) i = below(1 << kBits);
        }
        std::vector<float> place[6], area = randoms<float>(room, -1, 2);
        for (auto& v : place) v = randoms<float>(room, 0, 1);
        for (float& a : area) a = a < 0 ? (below(2) ? 0.0f : NAN) : a;
        const CellList cells{index[0].data(), index[1].data(), index[2].data(), {-1, 40, 900}, count};
        const CellPoints points{area.data(),     unit,
                                place[0].data(), place[1].data(),
                                place[2].data(), place[3].data(),
                                place[4].data(), place[5].data()};
        std::vector<float> out[7];
        std::vector<int> key(size_t(room), 0);
        for (auto& v : out) v.resize(size_t(room));
        const int packed = ours().pack_points(cells, points, spacing, kBits,
                                              {out[0].data(), out[1].data(), out[2].data(), out[3].data(),
                                               out[4].data(), out[5].data(), out[6].data(), key.data()});
        size_t at = 0;
        for (size_t n = 0; n < size_t(count); ++n) {
            if (!(area[n] > 0)) continue;
            for (size_t axis = 0; axis < 3; ++axis) {
                const float cell = float(cells.first[axis] + index[axis][n]);
                EXPECT_EQ(out[axis][at], (cell + place[axis][n]) * spacing[axis]);
                EXPECT_EQ(out[3 + axis][at], place[3 + axis][n]);
            }
            EXPECT_EQ(out[6][at], area[n] * unit);
            EXPECT_EQ(key[at++], index[0][n] | index[1][n] << kBits | index[2][n] << 2 * kBits);
        }
        EXPECT_EQ(packed, int(at));
    }
}

// Triangles of random cells and their halves, with the arrays that they live in.
struct PieceCase {
    std::vector<float> corner[9], area, longest, nx, ny, nz, sag, bend;
    std::vector<int> edge, triangle, cell, finest;
    explicit PieceCase(size_t room) {
        for (auto& v : corner) v.resize(room);
        for (auto* v : {&area, &longest, &nx, &ny, &nz, &sag, &bend}) v->resize(room);
        for (auto* v : {&edge, &triangle, &cell, &finest}) v->resize(room);
    }
    SurfaceTriangles triangles() {
        SurfaceTriangles t{{},         area.data(), nx.data(),   ny.data(),    nz.data(),
                           sag.data(), bend.data(), cell.data(), finest.data()};
        for (size_t n = 0; n < 9; ++n) t.corner[n] = corner[n].data();
        return t;
    }
    PieceArrays pieces() {
        PieceArrays p{{}, area.data(), longest.data(), edge.data(), triangle.data()};
        for (size_t n = 0; n < 9; ++n) p.corner[n] = corner[n].data();
        return p;
    }
};

TEST_P(CellKernels, TrianglesAndTheirHalves) {
    const std::vector<int> cases = packedCubeTriangles();
    for (int round = 0; round < 50; ++round) {
        CellCase cells{1 + below(64), {}, {}};
        const size_t room = 1024;
        for (auto& e : cells.excess) e = randoms<float>(int(room), -30000, 30000);
        cells.inside.assign(room, 0);
        for (size_t n = 0; n < room; ++n)
            for (int c = 0; c < 8; ++c) cells.inside[n] |= int(cells.excess[c][n] >= 0) << c;
        const auto x = randoms<float>(int(room), -1e-3, 1e-3), y = randoms<float>(int(room), -1e-3, 1e-3),
                   z = randoms<float>(int(room), -1e-3, 1e-3);
        const CellPlaces places{
            x.data(), y.data(), z.data(), {1e-4f, 2e-4f, 3e-4f}, {0, 1, 0, 0, 0, 1, 1, 0, 0}, 5e-5f};
        PieceCase made[2] = {PieceCase(room), PieceCase(room)};
        std::vector<float> out[2][9];
        std::vector<int> level[2];
        int count[2], all = 0;
        for (const int which : {0, 1}) {
            const Kernels& k = which ? ours() : oracle();
            PieceCase& m = made[which];
            count[which] = k.cell_triangles(cells.arrays(), cases.data(), places, m.triangles());
            for (int n = 0; n < count[which]; ++n) m.triangle[size_t(n)] = n, m.finest[size_t(n)] = n % 3 - 1;
            for (auto& v : out[which]) v.resize(room);
            level[which].resize(room);
            const MeasuredPieces measured{out[which][0].data(), out[which][1].data(), out[which][2].data(),
                                          out[which][3].data(), out[which][4].data(), out[which][5].data(),
                                          out[which][6].data(), out[which][7].data(), out[which][8].data(),
                                          level[which].data()};
            k.measure_pieces(m.pieces(), m.triangles(), 0, count[which], measured);
            std::vector<int> list(64);
            const int halved = std::min(count[which], 20);
            for (int n = 0; n < halved; ++n) list[size_t(n)] = count[which] - 1 - n;
            k.halve_pieces(m.pieces(), list.data(), halved, 400);
            all = halved;
            k.measure_pieces(m.pieces(), m.triangles(), 400, halved, measured);
            std::vector<float> centroids = out[which][0], near = out[which][1];
            const PieceRules rules{8e-4f, 1e-4f, 4, 1e-4f, 1e10f};
            k.level_pieces(rules, &m.longest[400], measured, centroids.data(), halved, near.data(),
                           level[which].data());
        }
        ASSERT_EQ(count[0], count[1]);
        for (size_t n = 0; n < 9; ++n) {
            expectSameBits(made[0].corner[n], made[1].corner[n], count[0]);
            expectSameBits(out[0][n], out[1][n], all);
        }
        expectSameBits(made[0].area, made[1].area, count[0]);
        expectSameBits(made[0].bend, made[1].bend, count[0]);
        expectSameBits(made[0].cell, made[1].cell, count[0]);
        expectSameBits(level[0], level[1], all);
        const int padded = (all + kCellLanes - 1) / kCellLanes * kCellLanes;
        const auto cornerOf = [&](size_t piece, size_t c) -> Eigen::Vector3d {
            const auto& k = made[0].corner;
            return {k[3 * c][piece], k[3 * c + 1][piece], k[3 * c + 2][piece]};
        };
        const auto areaOf = [&](size_t p) {
            return (cornerOf(p, 1) - cornerOf(p, 0)).cross(cornerOf(p, 2) - cornerOf(p, 0)).norm() / 2;
        };
        const auto middleOf = [&](size_t p) -> Eigen::Vector3d {
            return (cornerOf(p, 0) + cornerOf(p, 1) + cornerOf(p, 2)) / 3;
        };
        for (int n = 0; n < all; ++n) {  // two halves are the whole
            const auto whole = size_t(count[0] - 1 - n), low = size_t(400 + n), high = low + size_t(padded);
            for (const size_t half : {low, high}) {
                EXPECT_EQ(made[0].area[half], made[0].area[whole] / 2);
                EXPECT_NEAR(areaOf(half), made[0].area[whole] / 2, 1e-4 * made[0].area[whole] + 1e-14);
                EXPECT_EQ(made[0].triangle[half], int(whole));
                for (size_t c = 0; c < 9; ++c) EXPECT_EQ(made[0].corner[c][half], made[1].corner[c][half]);
            }
            EXPECT_LT((middleOf(low) + middleOf(high) - 2 * middleOf(whole)).norm(), 1e-9);
            EXPECT_GT((middleOf(low) - middleOf(high)).norm(), 0);
        }
    }
}

// A piece's distance falls no faster along its plane than it does at its centroid.
TEST_P(CellKernels, BoundsOfPieces) {
    for (const int n : {1, 15, 16, 17, 64}) {
        const size_t room = size_t(n) + kCellLanes;
        const auto d = randoms<float>(int(room), -1, 1), reach = randoms<float>(int(room), 0, 1);
        std::vector<float> g[3], normal[3];
        for (int axis = 0; axis < 3; ++axis)
            g[axis] = randoms<float>(int(room), -0.57f, 0.57f),
            normal[axis] = randoms<float>(int(room), -0.57f, 0.57f);
        auto centroids = randoms<float>(int(room), -1, 1), bounds = randoms<float>(int(room), -1, 1);
        const auto before = centroids, bounds_before = bounds;
        ours().lower_bounds(d.data(), g[0].data(), g[1].data(), g[2].data(), normal[0].data(),
                            normal[1].data(), normal[2].data(), reach.data(), n, centroids.data(),
                            bounds.data());
        for (size_t i = 0; i < size_t(n); ++i) {
            const double along = double(g[0][i]) * normal[0][i] + double(g[1][i]) * normal[1][i] +
                                 double(g[2][i]) * normal[2][i];
            const double bound = d[i] - std::sqrt(std::max(0.0, 1 - along * along)) * reach[i];
            EXPECT_EQ(centroids[i], std::min(before[i], d[i]));
            EXPECT_NEAR(bounds[i], std::min(double(bounds_before[i]), bound), 1e-5);
        }
    }
}

// Long pieces near the tool are cut, coarse ones first; those beyond are dropped.
TEST_P(CellKernels, LevelsOfPieces) {
    constexpr int kCount = 37;
    const PieceRules rules{.margin = 8e-4f,
                           .fine_within = 1e-4f,
                           .length_per_distance = 4,
                           .longest_enough = 2e-3f,
                           .per_spacing_squared = 1e10f};
    auto length = randoms<float>(kCount + kCellLanes, 0, 1e-7f),
         near = randoms<float>(kCount + kCellLanes, -1e-4f, 1.2e-3f),
         sag = randoms<float>(kCount + kCellLanes, 0, 1e-4f),
         of_triangle = randoms<float>(kCount + kCellLanes, 0, 1e-4f),
         centroids = randoms<float>(kCount + kCellLanes, 0, 1.5e-3f);
    std::vector<int> finest(kCount + kCellLanes), level(kCount + kCellLanes);
    for (size_t i = 0; i < finest.size(); ++i) finest[i] = int(i % 9) - 1;
    const auto before = near;
    MeasuredPieces measured{};
    measured.sag = sag.data(), measured.triangle_sag = of_triangle.data(), measured.finest = finest.data();
    ours().level_pieces(rules, length.data(), measured, centroids.data(), kCount, near.data(), level.data());
    int kinds[3] = {};
    for (size_t i = 0; i < kCount; ++i) {
        const float off = before[i] - sag[i];
        ASSERT_EQ(near[i], off);
        const float times = length[i] * rules.per_spacing_squared, enough = std::min(4 * off, 2e-3f);
        const int at = times > 1 ? std::ilogb(times) : -1;
        const bool is_cut = times > 1 && finest[i] <= at && (off < 1e-4f || length[i] > enough * enough);
        const int expected = !(off < 8e-4f)                              ? kPieceDropped
                             : is_cut                                    ? at
                             : centroids[i] - 2 * of_triangle[i] < 8e-4f ? kPieceFinished
                                                                         : kPieceFar;
        EXPECT_EQ(level[i], expected) << i;
        ++kinds[expected == kPieceDropped ? 0 : expected < kPieceLevels ? 1 : 2];
    }
    for (const int kind : kinds) EXPECT_GT(kind, 0);
}

// The share of bone in a cell that a slanted plane cuts, by counting.
TEST_P(CellKernels, CellFills) {
    const std::vector<int> cases = packedCubeTriangles();
    CellCase cells{64, {}, {}};
    for (auto& e : cells.excess) e.resize(64 + kCellLanes);
    cells.inside.assign(64 + kCellLanes, 0);
    std::vector<double> planes[4];
    for (size_t n = 0; n < 64; ++n) {
        const auto slope = randoms<float>(3, -1, 1);
        const double a = slope[0], b = slope[1], c = slope[2], d = -(a + b + c) / 2 + 0.001 * double(n % 7);
        for (int i = 0; i < 4; ++i) planes[i].push_back(i == 0 ? a : i == 1 ? b : i == 2 ? c : d);
        for (int corner = 0; corner < 8; ++corner) {
            const double e = 1e4 * (d + (corner & 1 ? a : 0) + (corner & 2 ? b : 0) + (corner & 4 ? c : 0));
            cells.excess[corner][n] = float(e);
            cells.inside[n] |= int(e >= 0) << corner;
        }
    }
    std::vector<float> fills[2] = {std::vector<float>(64 + kCellLanes), std::vector<float>(64 + kCellLanes)};
    oracle().cell_fills(cells.arrays(), cases.data(), fills[0].data());
    ours().cell_fills(cells.arrays(), cases.data(), fills[1].data());
    expectSameBits(fills[0], fills[1], 64);
    constexpr int kSteps = 24;
    for (size_t n = 0; n < 64; ++n) {
        int inside = 0;
        forEachIndex(
            {Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(kSteps - 1)}, [&](const Eigen::Vector3i& v) {
                const Eigen::Array3d p = (v.cast<double>().array() + 0.5) / kSteps;
                inside +=
                    planes[0][n] * p.x() + planes[1][n] * p.y() + planes[2][n] * p.z() + planes[3][n] >= 0;
            });
        EXPECT_NEAR(fills[0][n], double(inside) / (kSteps * kSteps * kSteps), 0.02);
    }
}

INSTANTIATE_TEST_SUITE_P(Cpu, CellKernels, testing::ValuesIn(kCpuLevels), test::levelName);

}  // namespace
}  // namespace bonemill

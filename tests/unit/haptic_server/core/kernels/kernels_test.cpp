// Every instruction set gives the bits of the baseline, and the baseline is right.
#include "haptic_server/core/kernels/kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "haptic_server/core/kernels/brick_layout.h"
#include "haptic_server/core/volume/marching_cubes_table.h"
#include "haptic_server/core/volume/voxel_volume.h"
#include "tests/unit/haptic_server/core/kernels/every_level.h"

namespace bonemill {
namespace {

using test::expectSameBits;

constexpr float kSpacing = 0.0973e-3f;  // no voxel exactly on a boundary

class VoxelKernels : public test::EveryLevel {
  protected:
    // A plane of voxels that begins anywhere before a burr of 1 mm, which goes so far, m.
    BurrPlane planeBesideAWay(float way, int amount) {
        const float z = float(below(1000)) * 1e-6f;
        return {.first_x = -float(below(20)) * kSpacing,
                .step_x = kSpacing,
                .first_y = -float(below(20)) * kSpacing,
                .step_y = kSpacing,
                .off_plane_squared = z * z,
                .way_x = 0.6f,
                .way_y = 0.48f,
                .off_plane_along = 0.64f * z,
                .way = way,
                .radius = 1e-3f,
                .slope = 1,
                .reach_squared = 0.9e-3f * 0.9e-3f,
                .core_squared = 0.9e-3f * 0.9e-3f,
                .iso = 30000,
                .amount = amount};
    }
};

TEST_P(VoxelKernels, ContactSumsAreThoseOfPlainLoops) {
    const ContactFrame frame{{0, 0, 1, 0.8, 0.6, 0, -0.6, 0.8, 0}, {1e-4, 2e-4, -3e-4}, 0.2e-3};
    for (int round = 0; round < 100; ++round) {
        const int n = 1 + below(kContactBatch);
        const auto x = randoms<float>(n, -1e-3, 1e-3), y = randoms<float>(n, -1e-3, 1e-3),
                   z = randoms<float>(n, -1e-3, 1e-3), weight = randoms<float>(n, 10, 1e4),
                   depth = randoms<float>(n, -0.3e-3, -1e-9), gx = randoms<float>(n, -1, 1),
                   gy = randoms<float>(n, -1, 1), gz = randoms<float>(n, -1, 1);
        ContactSums sums[2];
        for (const int which : {0, 1})
            (which ? ours() : oracle())
                .single.add_contacts(frame, x.data(), y.data(), z.data(), weight.data(), depth.data(),
                                     gx.data(), gy.data(), gz.data(), n, sums[which]);
        EXPECT_EQ(std::memcmp(&sums[0], &sums[1], sizeof sums[0]), 0);
        double energy = 0, force_x = 0, torque_z = 0, k_xx = 0, k_zz = 0, deepest = 0;
        for (size_t i = 0; i < size_t(n); ++i) {
            const double d = -depth[i], capped = std::min(d, 0.2e-3), w = weight[i];
            const double g[3] = {gz[i], 0.8 * gx[i] + 0.6 * gy[i], -0.6 * gx[i] + 0.8 * gy[i]};
            const double r[2] = {x[i] - 1e-4, y[i] - 2e-4};
            const double k = d > 0.2e-3 ? w * 0.2e-3 / d : w, turning = r[0] * g[1] - r[1] * g[0];
            energy += w * capped * (d - capped / 2);
            force_x -= w * capped * g[0];
            torque_z -= w * capped * turning;
            k_xx += k * g[0] * g[0];
            k_zz += k * turning * turning;
            deepest = std::max(deepest, d);
        }
        EXPECT_NEAR(sums[0].energy, energy, 1e-9 * energy);
        EXPECT_NEAR(sums[0].force[0], force_x, 1e-6);
        EXPECT_NEAR(sums[0].torque[2], torque_z, 1e-9);
        EXPECT_NEAR(sums[0].stiffness[0], k_xx, 1e-6 * k_xx);
        EXPECT_NEAR(sums[0].stiffness[20], k_zz, 1e-6 * k_zz);
        EXPECT_EQ(sums[0].max_depth, deepest);
    }
}

// The place is x, y from where the burr sets out.
double squaredFromWay(const BurrPlane& burr, double x, double y) {
    const double along = x * double(burr.way_x) + y * double(burr.way_y) + double(burr.off_plane_along);
    const double nearest = std::clamp(along, 0.0, double(burr.way));
    return x * x + y * y + double(burr.off_plane_squared) + nearest * (nearest - 2 * along);
}

// A plane of a brick is compared with plain arithmetic in double.
TEST_P(VoxelKernels, MilledPlanes) {
    for (int round = 0; round < 300; ++round) {
        const int n = 1 + below(kBrickCells), rows = 1 + below(kBrickCells);
        std::vector<uint16_t> plane(kBrickStrideZ), out[2];
        for (uint16_t& d : plane) d = uint16_t(below(3) == 0 ? below(65536) : below(2) * 65535);
        const bool removes = round % 2, goes = round % 4 < 2;
        BurrPlane burr = planeBesideAWay(goes ? float(1 + below(900)) * 1e-6f : 0, 1 + below(65535));
        burr.slope = burr.iso / kSpacing;
        burr.reach_squared = 1.1e-3f * 1.1e-3f;
        MilledPlane milled[2];
        for (const int which : {0, 1}) {
            out[which].assign(kBrickCells * kBrickCells, 7);
            const Kernels& k = which ? ours() : oracle();
            milled[which] =
                (removes ? k.remove_plane : k.add_plane)(burr, plane.data(), n, rows, out[which].data());
        }
        EXPECT_EQ(std::memcmp(&milled[0], &milled[1], sizeof milled[0]), 0);
        int removed = 0, added = 0;
        for (int r = 0; r < rows; ++r) {
            const bool is_changed = milled[0].is_changed >> r & 1;
            bool is_any = false;
            for (int i = 0; i < n; ++i) {
                const double x = burr.first_x + i * double(kSpacing), y = burr.first_y + r * double(kSpacing);
                const double squared = squaredFromWay(burr, x, y);
                const double ramp =
                    burr.iso - (removes ? -1 : 1) * burr.slope * (std::sqrt(squared) - burr.radius);
                double limit = std::clamp(ramp, 0.0, 65535.0);
                if (squared < burr.core_squared) limit = removes ? 0 : 65535;
                const uint16_t old = plane[size_t(r) * kBrickStrideY + size_t(i)];
                double now = removes ? std::min<double>(old, std::max(limit, double(old) - burr.amount))
                                     : std::max<double>(old, std::min(limit, double(old) + burr.amount));
                if (squared >= burr.reach_squared) now = old;
                const size_t at = size_t(r * kBrickCells + i);
                const uint16_t fresh = is_changed ? out[0][at] : old;
                if (is_changed) {
                    EXPECT_EQ(out[0][at], out[1][at]);
                }
                EXPECT_NEAR(fresh, now, 0.6) << i << ' ' << r;
                is_any |= fresh != old;
                removed += old >= burr.iso && fresh < burr.iso;
                added += old < burr.iso && fresh >= burr.iso;
            }
            EXPECT_EQ(is_changed, is_any);
        }
        EXPECT_EQ(milled[0].removed, removed);
        EXPECT_EQ(milled[0].added, added);
        EXPECT_EQ(milled[0].is_changed >> rows, 0u);
    }
}

TEST_P(VoxelKernels, LaidPlanes) {
    for (int round = 0; round < 300; ++round) {
        const int n = 1 + below(kBrickCells), rows = 1 + below(kBrickCells);
        std::vector<uint16_t> plane(kBrickStrideZ), shall(kBrickStrideZ), out[2];
        for (uint16_t& d : plane) d = uint16_t(below(2) * below(65536));
        for (uint16_t& d : shall) d = uint16_t(below(2) * below(65536));
        const BurrPlane place = planeBesideAWay(float(below(900)) * 1e-6f, below(65536));
        LaidPlane laid[2];
        for (const int which : {0, 1}) {
            out[which].assign(kBrickCells * kBrickCells, 7);
            const Kernels& k = which ? ours() : oracle();
            laid[which] = k.lay_plane(place, shall.data(), plane.data(), n, rows, out[which].data());
        }
        int added = 0;
        bool is_owed = false;
        for (int r = 0; r < rows; ++r)
            for (int i = 0; i < n; ++i) {
                const size_t at = size_t(r) * kBrickStrideY + size_t(i), to = size_t(r * kBrickCells + i);
                const double x = place.first_x + i * double(kSpacing),
                             y = place.first_y + r * double(kSpacing);
                const bool is_free = squaredFromWay(place, x, y) >= double(place.core_squared);
                const int old = plane[at], end = is_free ? shall[at] : 0;
                const int now = std::max(old, std::min(end, old + place.amount));
                const int fresh = laid[0].is_changed >> r & 1 ? out[0][to] : old;
                EXPECT_EQ(fresh, now) << i << ' ' << r;
                added += old < place.iso && fresh >= place.iso;
                is_owed |= shall[at] > now;
            }
        EXPECT_EQ(laid[0].added, added);
        EXPECT_EQ(laid[0].is_owed, is_owed);
        EXPECT_EQ(laid[1].added, added);
        EXPECT_EQ(laid[1].is_owed, is_owed);
        EXPECT_EQ(laid[1].is_changed, laid[0].is_changed);
        EXPECT_EQ(out[0], out[1]);
    }
}

TEST_P(VoxelKernels, NearPointsOfABlock) {
    int all_near = 0, all_far = 0;
    for (int round = 0; round < 100; ++round) {
        const int n = 1 + below(kContactBatch);
        const auto distance = randoms<float>(n, -1e-3, 1e-3);
        std::vector<std::vector<float>> g, m;  // gradient and normal
        for (int axis = 0; axis < 3; ++axis) {
            g.push_back(randoms<float>(n, -1, 1));
            m.push_back(randoms<float>(n, -1, 1));
        }
        const NearTest test{
            {0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0, 0.48f, 0.64f, 0.6f}, 0.2e-3f, 0.05e-3f, 20e-6f};
        std::vector<float> nearest[2];
        std::vector<int> selected[2];
        int found[2];
        for (const int which : {0, 1}) {
            nearest[which].resize(kContactBatch);
            selected[which].resize(kContactBatch);
            found[which] =
                (which ? ours() : oracle())
                    .select_near(test, distance.data(), g[0].data(), g[1].data(), g[2].data(), m[0].data(),
                                 m[1].data(), m[2].data(), n, nearest[which].data(), selected[which].data());
        }
        ASSERT_EQ(found[0], found[1]);
        expectSameBits(nearest[0], nearest[1], n);
        expectSameBits(selected[0], selected[1], found[0]);
        int next = 0;
        for (size_t i = 0; i < size_t(n); ++i) {
            const Eigen::Vector3d g_V =
                Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(test.R_VT).cast<double>() *
                Eigen::Vector3d(g[0][i], g[1][i], g[2][i]);
            const double in_plane = g_V.cross(Eigen::Vector3d(m[0][i], m[1][i], m[2][i])).norm();
            const double place = distance[i] - std::min(in_plane * 0.2e-3 + 0.05e-3, 0.2e-3);
            EXPECT_NEAR(nearest[1][i], place, 1e-9);
            if (nearest[1][i] < test.margin) {
                ASSERT_LT(next, found[1]);
                EXPECT_EQ(selected[1][size_t(next++)], int(i));
            }
        }
        EXPECT_EQ(next, found[1]);
        all_near += next, all_far += n - next;
    }
    EXPECT_GT(all_near, 100);
    EXPECT_GT(all_far, 100);
}

TEST_P(VoxelKernels, LeastScaledAndRanges) {
    for (int round = 0; round < 200; ++round) {
        const int n = 1 + below(100);
        const auto value = randoms<float>(n, -1, 1), lowest = randoms<float>(n, -1, 1),
                   scale = randoms<float>(n, 0, 9);
        float least = 0.25f;
        for (size_t i = 0; i < size_t(n); ++i) least = std::min(least, (value[i] - lowest[i]) * scale[i]);
        EXPECT_EQ(ours().least_scaled(value.data(), lowest.data(), scale.data(), n, 0.25f), least);

        const int width = 1 + below(40), rows = 1 + below(5);
        const size_t stride = size_t(width) + size_t(below(4));
        std::vector<uint16_t> box(stride * size_t(rows - 1) + size_t(width));
        for (uint16_t& d : box) d = uint16_t(20000 + below(10000));
        uint16_t low = 25000, high = 25000, expected_low = low, expected_high = high;
        for (int r = 0; r < rows; ++r)
            for (int i = 0; i < width; ++i) {
                const uint16_t d = box[size_t(r) * stride + size_t(i)];
                expected_low = std::min(expected_low, d), expected_high = std::max(expected_high, d);
            }
        ours().range_of_rows(box.data(), width, stride, rows, low, high);
        EXPECT_EQ(low, expected_low);
        EXPECT_EQ(high, expected_high);
    }
}

TEST_P(VoxelKernels, SidesOfALayerOfCells) {
    constexpr uint16_t iso = 30000;
    for (int round = 0; round < 200; ++round) {
        const int columns = 2 + below(40), rows = 1 + below(6);
        const size_t stride_y = size_t(columns + below(4)), stride_z = stride_y * size_t(rows + 1);
        std::vector<uint16_t> voxels(2 * stride_z + kCellLanes);
        for (uint16_t& d : voxels) d = uint16_t(iso - 10 + below(20));
        const size_t row_size = size_t(columns + kCellLanes);
        std::vector<uint8_t> sides(row_size * size_t(rows));
        ours().cell_sides({voxels.data(), stride_y, stride_z}, columns, rows, iso, row_size, sides.data());
        for (int r = 0; r < rows; ++r) {
            const uint8_t* row = sides.data() + row_size * size_t(r);
            for (int i = 0; i < columns; ++i) {
                const uint16_t* v = voxels.data() + stride_y * size_t(r) + i;
                const int expected = (v[0] >= iso) | (v[stride_y] >= iso) << 2 | (v[stride_z] >= iso) << 4 |
                                     (v[stride_y + stride_z] >= iso) << 6;
                EXPECT_EQ(row[i], expected);
            }
            for (int i = 0; i < kCellsAtOnce; ++i) EXPECT_EQ(row[columns + i], row[columns - 1]);
        }
    }
}

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

TEST_P(VoxelKernels, CellPatchesAndProjections) {
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

// A point moves onto a flat face between the voxels, and stays where the face is too far off.
TEST_P(VoxelKernels, PointsMoveOntoTheSurface) {
    constexpr int kEdge = 20;
    VolumeGeometry geometry;
    geometry.dims = Eigen::Vector3i::Constant(kEdge);
    VoxelVolume volume(geometry, 30000);
    volume.fill([](int i, int j, int k) {
        return Density(std::clamp(30000 + 2000 * (9.3 + 0.2 * i - 0.1 * j - k), 0.0, 65535.0));
    });
    const BrickStore& bricks = volume.bricks();
    const DensityView view{
        bricks.data(),         bricks.slots(), bricks.bricksPerAxis().x(), bricks.bricksPerAxis().y(),
        {kEdge, kEdge, kEdge}, 30000,          {1e3f, 1e3f, 1e3f},         {2e-3f, 1e-3f, 0}};
    for (int round = 0; round < 50; ++round) {
        const int n = 1 + below(60);
        const auto x = randoms<float>(n, 0, 15e-3), y = randoms<float>(n, 0, 15e-3),
                   off = randoms<float>(n, -1e-3, 1e-3);
        std::vector<float> p[2][3], start;
        for (const int which : {0, 1}) {
            p[which][0] = x, p[which][1] = y, p[which][2] = off;
            for (size_t i = 0; i < x.size(); ++i)
                p[which][2][i] += float(1e-3 * (9.3 + 0.2 * (x[i] + 2e-3) * 1e3 - 0.1 * (y[i] + 1e-3) * 1e3));
            start = p[which][2];
            (which ? ours() : oracle())
                .move_onto_surface(view, 2,
                                   {p[which][0].data(), p[which][1].data(), p[which][2].data(), 0.5e-3f, n});
        }
        for (int axis = 0; axis < 3; ++axis) expectSameBits(p[0][axis], p[1][axis], n);
        for (size_t i = 0; i < size_t(n); ++i) {
            const double distance = std::abs(off[i]) / std::sqrt(1 + 0.04 + 0.01);
            if (distance > 0.51e-3) {
                EXPECT_EQ(p[0][2][i], start[i]);
            }
            if (distance > 0.49e-3) continue;
            const double on_face = 9.3 + 0.2 * (p[0][0][i] + 2e-3) * 1e3 - 0.1 * (p[0][1][i] + 1e-3) * 1e3;
            EXPECT_NEAR(p[0][2][i] * 1e3, on_face, 2e-3);
        }
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

TEST_P(VoxelKernels, TrianglesAndTheirHalves) {
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
TEST_P(VoxelKernels, BoundsOfPieces) {
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
TEST_P(VoxelKernels, LevelsOfPieces) {
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
TEST_P(VoxelKernels, CellFills) {
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

INSTANTIATE_TEST_SUITE_P(Cpu, VoxelKernels, testing::ValuesIn(kCpuLevels), test::levelName);

}  // namespace
}  // namespace bonemill

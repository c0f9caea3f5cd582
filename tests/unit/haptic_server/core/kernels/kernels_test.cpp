// Every instruction set gives the bits of the baseline, and the baseline is right.
#include "haptic_server/core/kernels/kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "haptic_server/core/kernels/brick_layout.h"
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

// The sums are compared with those by Eigen, contact by contact.
TEST_P(VoxelKernels, RubbingSumsAreThoseOfPlainLoops) {
    using Eigen::Vector3d;
    const RubbingMotion m{{0.48, 0.6, 0.64}, -3000, {0.02, -0.05, 0.03}, {1, 2, -3}, 0.5, 1e-4, 20};
    const Vector3d axis(m.axis), v(m.velocity), omega(m.angular_velocity);
    for (int round = 0; round < 100; ++round) {
        const int n = 1 + below(kContactBatch);
        const auto rx = randoms<float>(n, -1e-3, 1e-3), ry = randoms<float>(n, -1e-3, 1e-3),
                   rz = randoms<float>(n, -1e-3, 1e-3), force = randoms<float>(n, 0, 0.3);
        auto nx = randoms<float>(n, -1, 1), ny = randoms<float>(n, -1, 1), nz = randoms<float>(n, -1, 1);
        const auto spread = randoms<double>(n, 0, 1e-9), rho = randoms<double>(n, 1e-4, 1e-3);
        Vector3d pull = Vector3d::Zero(), torque = pull;
        double per_speed = 0;
        Eigen::Matrix3d of_rr = Eigen::Matrix3d::Zero();
        Eigen::Matrix<double, 6, 6> of_ww = Eigen::Matrix<double, 6, 6>::Zero();
        for (size_t i = 0; i < size_t(n); ++i) {
            const Eigen::Vector3f unit = Eigen::Vector3f(nx[i], ny[i], nz[i]).normalized();
            nx[i] = unit.x(), ny[i] = unit.y(), nz[i] = unit.z();
            const Vector3d r(rx[i], ry[i], rz[i]), normal = unit.cast<double>();
            const Eigen::Matrix3d beside = Eigen::Matrix3d::Identity() - normal * normal.transpose();
            const Vector3d turn = beside * axis.cross(r),
                           slip = m.spin * turn + beside * (v + omega.cross(r));
            const double d = m.friction * double(force[i]) /
                             std::sqrt(slip.squaredNorm() + m.spin * m.spin * spread[i] + m.slow_squared);
            const double per_turn = d * m.spin + m.held_per_moment * double(force[i]) / rho[i];
            pull -= per_turn * turn;
            torque -= per_turn * (r.cross(turn) + spread[i] * axis);
            per_speed += d;
            of_rr += d * r * r.transpose();
            Eigen::Matrix<double, 6, 1> w;
            w << normal, r.cross(normal);
            of_ww += d * w * w.transpose();
        }
        RubbingSums sums[2];
        for (const int which : {0, 1})
            (which ? ours() : oracle())
                .add_rubbing(m,
                             {rx.data(), ry.data(), rz.data(), nx.data(), ny.data(), nz.data(), force.data(),
                              spread.data(), rho.data(), n},
                             sums[which]);
        EXPECT_EQ(std::memcmp(&sums[0], &sums[1], sizeof sums[0]), 0);
        EXPECT_LT((Vector3d(sums[0].force) - pull).norm(), 1e-9);
        EXPECT_LT((Vector3d(sums[0].torque) - torque).norm(), 1e-12);
        EXPECT_NEAR(sums[0].per_speed, per_speed, 1e-12);
        EXPECT_NEAR(sums[0].of_rr[1], of_rr(0, 1), 1e-15);
        EXPECT_NEAR(sums[0].of_rr[5], of_rr(2, 2), 1e-15);
        EXPECT_NEAR(sums[0].of_ww[4], of_ww(0, 4), 1e-12);
        EXPECT_NEAR(sums[0].of_ww[20], of_ww(5, 5), 1e-15);
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

INSTANTIATE_TEST_SUITE_P(Cpu, VoxelKernels, testing::ValuesIn(kCpuLevels), test::levelName);

}  // namespace
}  // namespace bonemill

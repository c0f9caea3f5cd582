// Kernels that move the surface into the bone: every instruction set gives the bits of the baseline, and the
// baseline is right.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/volume/density_view.h"
#include "tests/unit/haptic_server/core/kernels/every_level.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using test::expectSameBits;

class ShiftKernels : public test::EveryLevel {};

constexpr int kEdge = 24;
constexpr Density kIso = 20000;

VoxelVolume volumeOf(const std::function<double(const Vector3i&)>& density) {
    VolumeGeometry geometry;
    geometry.dims = Vector3i::Constant(kEdge);
    geometry.spacing = {1e-3, 0.8e-3, 0.5e-3};
    VoxelVolume volume(geometry, kIso);
    forEachIndex({Vector3i::Zero(), Vector3i::Constant(kEdge - 1)}, [&](const Vector3i& v) {
        volume.set(v.x(), v.y(), v.z(), Density(std::clamp(density(v), 0.0, double(kMaxDensity))));
    });
    return volume;
}

struct Sinking {
    std::vector<float> x, y, z, recession, least, drop;
    explicit Sinking(size_t count) : x(count + kCellLanes), y(x), z(x), recession(x), least(x), drop(x) {}
    SinkingPoints points(int count) {
        return {x.data(), y.data(), z.data(), recession.data(), least.data(), drop.data(), count};
    }
};

// Cells of every kind, in any order, at the volume's border too.
TEST_P(ShiftKernels, ReadCellsAreTheVolumes) {
    const VoxelVolume volume = volumeOf([&](const Vector3i& v) {
        const double density = below(8) == 0 ? kIso : below(kMaxDensity);
        return v.x() < 8 ? 0.0 : v.x() > 15 ? 6e4 : density;
    });
    for (int round = 0; round < 40; ++round) {
        const int count = below(90);
        const auto room = size_t(count) + kCellLanes;
        std::vector<int> at[3], inside[2], crossed_inside[2], place[2];
        for (auto& indices : at)
            for (size_t n = 0; n < room; ++n) indices.push_back(below(kEdge + 1) - 1 + round);
        const CellList cells{at[0].data(), at[1].data(), at[2].data(), {-round, -round, -round}, count};
        std::vector<float> excess[2][8];
        int crossed[2];
        for (const int which : {0, 1}) {
            for (auto* values : {&inside[which], &crossed_inside[which], &place[which]}) values->resize(room);
            ReadCells out{inside[which].data(), {}, crossed_inside[which].data(), place[which].data()};
            for (int c = 0; c < 8; ++c) {
                excess[which][c].resize(room);
                out.excess[c] = excess[which][c].data();
            }
            crossed[which] = (which ? ours() : oracle()).read_cells(densityView(volume), cells, out);
        }
        ASSERT_EQ(crossed[0], crossed[1]);
        expectSameBits(inside[0], inside[1], count);
        expectSameBits(crossed_inside[0], crossed_inside[1], crossed[0]);
        expectSameBits(place[0], place[1], crossed[0]);
        for (int c = 0; c < 8; ++c) expectSameBits(excess[0][c], excess[1][c], crossed[0]);
        int next = 0;
        for (size_t n = 0; n < size_t(count); ++n) {
            const auto densityOf = [&](int c) {
                return volume.at(at[0][n] - round + (c & 1), at[1][n] - round + (c >> 1 & 1),
                                 at[2][n] - round + (c >> 2 & 1));
            };
            int corners = 0;
            for (int c = 0; c < 8; ++c) corners |= int(densityOf(c) >= kIso) << c;
            ASSERT_EQ(inside[1][n], corners);
            if (corners == 0 || corners == 255) continue;
            ASSERT_LT(next, crossed[1]);
            ASSERT_EQ(place[1][size_t(next)], int(n));
            ASSERT_EQ(crossed_inside[1][size_t(next)], corners);
            for (int c = 0; c < 8; ++c)
                ASSERT_EQ(excess[1][c][size_t(next)], float(int(densityOf(c)) - int(kIso)));
            ++next;
        }
        EXPECT_EQ(next, crossed[1]);
    }
}

// Also around whole numbers, and where the room for writing ends.
TEST_P(ShiftKernels, HatBoxesAreTheVoxelsWithAWeight) {
    constexpr int kLow[3] = {-1, 2, 0}, kHigh[3] = {9, 7, 11};
    for (int round = 0; round < 40; ++round) {
        const int count = below(70), width = 1 + below(3);
        std::vector<float> at[3];
        std::vector<int> first[2][3], counts[2][3];
        HatBoxes boxes[2];
        for (int axis = 0; axis < 3; ++axis) {
            at[axis] = randoms<float>(count, -4, 14);
            for (size_t n = 0; n < size_t(count); n += 3) at[axis][n] = std::round(at[axis][n]);
            for (size_t n = size_t(count); n < at[axis].size(); ++n) at[axis][n] = n % 2 ? NAN : -1e30f;
            for (const int which : {0, 1}) {
                first[which][axis].resize(at[axis].size()), counts[which][axis].resize(at[axis].size());
                boxes[which].at[axis] = at[axis].data();
                boxes[which].low[axis] = kLow[axis], boxes[which].high[axis] = kHigh[axis];
                boxes[which].first[axis] = first[which][axis].data();
                boxes[which].count[axis] = counts[which][axis].data();
            }
        }
        boxes[0].width = boxes[1].width = float(width);
        oracle().hat_boxes(boxes[0], count);
        ours().hat_boxes(boxes[1], count);
        for (int axis = 0; axis < 3; ++axis) {
            expectSameBits(first[0][axis], first[1][axis], count);
            expectSameBits(counts[0][axis], counts[1][axis], count);
            for (size_t n = 0; n < size_t(count); ++n) {
                int voxels = 0, least = kHigh[axis] + 1;
                for (int v = kHigh[axis]; v >= kLow[axis]; --v)
                    if (std::abs(float(v) - at[axis][n]) < float(width)) ++voxels, least = v;
                EXPECT_EQ(std::max(counts[1][axis][n], 0), voxels);
                if (voxels > 0) {
                    EXPECT_EQ(first[1][axis][n], least);
                }
            }
        }
    }
}

// In a ramp of densities places sink straight down, and the densities fall by what they rise on the way.
TEST_P(ShiftKernels, ARampFallsByWhatItRisesOverTheRecession) {
    const Vector3d slope(900, 500, 700);  // counts per voxel
    const auto ramp = [&](const Vector3i& v) { return 2000 + slope.dot(v.cast<double>()); };
    const VoxelVolume volume = volumeOf(ramp);
    constexpr int kCount = 37;
    Sinking ours_(kCount), oracle_(kCount);
    const Vector3d gradient = slope.cwiseQuotient(volume.spacing());  // counts per m
    std::vector<Vector3d> from;
    for (size_t n = 0; n < kCount; ++n) {
        const auto at = randoms<float>(3, 4, kEdge - 6);
        from.push_back(Vector3d(at[0], at[1], at[2]).cwiseProduct(volume.spacing()));
        for (Sinking* s : {&ours_, &oracle_}) {
            s->x[n] = float(from[n].x()), s->y[n] = float(from[n].y()), s->z[n] = float(from[n].z());
            s->recession[n] = float(n % 5) * 1e-4f;
            s->least[n] = n % 7 == 0 ? 1500.0f : 0.0f;
        }
    }
    ours().sink_surface(densityView(volume), ours_.points(kCount));
    oracle().sink_surface(densityView(volume), oracle_.points(kCount));
    expectSameBits(ours_.drop, oracle_.drop, kCount);
    expectSameBits(ours_.x, oracle_.x, kCount);
    expectSameBits(ours_.y, oracle_.y, kCount);
    expectSameBits(ours_.z, oracle_.z, kCount);
    for (size_t n = 0; n < kCount; ++n) {
        const double s = double(ours_.recession[n]);
        const Vector3d to = (from[n] + s * gradient.normalized()).cwiseQuotient(volume.spacing());
        EXPECT_NEAR(ours_.x[n], to.x(), 2e-4);
        EXPECT_NEAR(ours_.y[n], to.y(), 2e-4);
        EXPECT_NEAR(ours_.z[n], to.z(), 2e-4);
        EXPECT_NEAR(ours_.drop[n], std::max(s * gradient.norm(), double(ours_.least[n])), 2);
    }
}

// Corners at zero stay there; the others make up for them.
TEST_P(ShiftKernels, TheDensityAtThePlaceFallsByTheWholeExcess) {
    const VoxelVolume volume = volumeOf([](const Vector3i& v) {
        return v.x() < 11 ? 0.0 : v.x() == 11 ? 3000.0 : 50000.0;
    });
    Sinking s(1);
    const Vector3d at(11.4, 10.3, 12.6);
    const Vector3d p = at.cwiseProduct(volume.spacing());
    s.x[0] = float(p.x()), s.y[0] = float(p.y()), s.z[0] = float(p.z());
    s.least[0] = 12000;
    ours().sink_surface(densityView(volume), s.points(1));
    const double share = 0.4;  // of the corners that fall all the way
    const double fallen = (1 - share) * std::min(3000.0, double(s.drop[0])) + share * double(s.drop[0]);
    EXPECT_NEAR(fallen, 12000, 5);
    EXPECT_GT(s.drop[0], 12000);
}

// Sums of a hat over a box, its neighbours untouched.
TEST_P(ShiftKernels, AHatGoesToItsVoxelsAlone) {
    constexpr int kSize = 20;
    const auto index = [](int i, int j, int k) { return size_t(i + kSize * (j + kSize * k)); };
    for (int round = 0; round < 40; ++round) {
        const auto place = randoms<float>(3, 6, 12);
        const float width = float(1 + below(4)), area = 0.7f, drop = 120;
        VoxelHat hat{.at = {place[0], place[1], place[2]},
                     .width = width,
                     .first = {},
                     .count = {},
                     .stride_y = kSize,
                     .stride_z = kSize * kSize};
        for (int axis = 0; axis < 3; ++axis) {
            hat.first[axis] = int(std::floor(place[size_t(axis)] - width)) + 1;
            hat.count[axis] = int(std::ceil(place[size_t(axis)] + width)) - hat.first[axis];
        }
        std::vector<float> drops[2], weights[2], rest[2];
        const size_t first = index(hat.first[0], hat.first[1], hat.first[2]);
        for (const size_t which : {0u, 1u}) {
            const Kernels& k = which ? ours() : oracle();
            drops[which].assign(kSize * kSize * kSize + kCellLanes, 3);
            weights[which].assign(drops[which].size(), 2);
            rest[which].assign(drops[which].size(), 0);
            for (size_t n = 0; n < rest[which].size(); n += 2) rest[which][n] = 5;
            k.add_hat(hat, area, drop, &drops[which][first], &weights[which][first]);
            k.add_hat_where_any(hat, area, &rest[which][first]);
        }
        expectSameBits(drops[0], drops[1], kSize * kSize * kSize);
        expectSameBits(weights[0], weights[1], kSize * kSize * kSize);
        expectSameBits(rest[0], rest[1], kSize * kSize * kSize);
        const auto off = [&](int voxel, int axis) {
            return std::max(0.0, double(width) - std::abs(voxel - double(place[size_t(axis)])));
        };
        forEachIndex({Vector3i::Zero(), Vector3i::Constant(kSize - 1)}, [&](const Vector3i& v) {
            const size_t n = index(v.x(), v.y(), v.z());
            const double share = off(v.x(), 0) * off(v.y(), 1) * off(v.z(), 2) * double(area);
            EXPECT_NEAR(weights[1][n], 2 + share, 1e-4);
            EXPECT_NEAR(drops[1][n], 3 + share * drop, 1e-2);
            EXPECT_NEAR(rest[1][n], n % 2 == 0 ? 5 + share : 0, 1e-4);
        });
    }
}

INSTANTIATE_TEST_SUITE_P(Cpu, ShiftKernels, testing::ValuesIn(kCpuLevels), test::levelName);

}  // namespace
}  // namespace bonemill

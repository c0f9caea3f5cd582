#include "haptic_server/cases/phantom/third_molar_phantom.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "common/base/units.h"
#include "haptic_server/core/volume/index_box.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;
using Impaction = ThirdMolarKind::Impaction;
using Nerve = ThirdMolarKind::Nerve;

ThirdMolarKind molarKind(uint64_t seed, Impaction impaction = Impaction::kShallow,
                         Nerve nerve = Nerve::kFar) {
    ThirdMolarKind kind;
    kind.seed = seed;
    kind.impaction = impaction;
    kind.nerve = nerve;
    return kind;
}

template <class See>
void forEachPlace(const VolumeGeometry& g, See&& see) {
    size_t n = 0;
    forEachIndex({Vector3i::Zero(), (g.dims.array() - 1).matrix()}, [&](const Vector3i& v) {
        see(n++, Vector3d(g.X_WV * g.spacing.cwiseProduct(v.cast<double>())));
    });
}

// The least distance of a surface to places inside the third molar, in mm.
template <class Distance>
double leastToThird_mm(const ThirdMolar& molar, Distance&& distance) {
    double least = INFINITY;
    forEachPlace(molar.grid(0.4e-3), [&](size_t, const Vector3d& p_W) {
        const double outside = molar.thirdMolarDistance(p_W);
        if (std::abs(outside) < 0.8e-3) least = std::min(least, distance(p_W) + outside);
    });
    return least * kPerMillimetre;
}

double top_mm(const ThirdMolar& molar) {
    double top = -INFINITY;
    forEachPlace(molar.grid(0.25e-3), [&](size_t, const Vector3d& p_W) {
        if (molar.thirdMolarDistance(p_W) < 0) top = std::max(top, p_W.z());
    });
    return top * kPerMillimetre;
}

TEST(ThirdMolar, CrownLiesAsDeepAsIsSaid) {
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        EXPECT_NEAR(top_mm(ThirdMolar(molarKind(seed, Impaction::kShallow))), 0.7, 0.4) << seed;
        EXPECT_NEAR(top_mm(ThirdMolar(molarKind(seed, Impaction::kMiddle))), -1.5, 0.4) << seed;
        EXPECT_NEAR(top_mm(ThirdMolar(molarKind(seed, Impaction::kDeep))), -4, 0.4) << seed;
    }
}

TEST(ThirdMolar, NerveIsAsFarFromTheRootsAsIsSaid) {
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        const auto gap_mm = [&](Nerve nerve) {
            const ThirdMolar molar(molarKind(seed, Impaction::kMiddle, nerve));
            return leastToThird_mm(molar, [&](const Vector3d& p_W) { return molar.nerveDistance(p_W); });
        };
        EXPECT_NEAR(gap_mm(Nerve::kFar), 3, 0.7) << seed;
        EXPECT_NEAR(gap_mm(Nerve::kNear), 1.2, 0.5) << seed;
        EXPECT_NEAR(gap_mm(Nerve::kTouching), 0.3, 0.4) << seed;
    }
}

TEST(ThirdMolar, LeavesRoomToTheSecondMolar) {
    for (uint64_t seed = 1; seed <= 4; ++seed)
        for (const Impaction impaction : {Impaction::kShallow, Impaction::kMiddle, Impaction::kDeep}) {
            const ThirdMolar molar(molarKind(seed, impaction));
            const double gap =
                leastToThird_mm(molar, [&](const Vector3d& p_W) { return molar.secondMolarDistance(p_W); });
            EXPECT_GT(gap, 0.1) << seed << " " << int(impaction);
            EXPECT_LT(gap, 3) << seed << " " << int(impaction);
        }
}

TEST(ThirdMolar, VolumesOfLabelsAreThoseOfTheShapes) {
    const ThirdMolar molar(molarKind(2, Impaction::kMiddle, Nerve::kNear));
    const VolumeGeometry grid = molar.grid(0.3e-3);
    const MolarScan scan = molar.scan(grid);
    std::map<MolarTissue, size_t> voxels;
    std::map<MolarTissue, std::pair<double, double>> hu;
    forEachPlace(grid, [&](size_t n, const Vector3d& p_W) {
        const auto tissue = MolarTissue(scan.labels[n]);
        ++voxels[tissue];
        const double nerve = molar.nerveDistance(p_W), third = molar.thirdMolarDistance(p_W);
        if (tissue == MolarTissue::kNerve) {
            EXPECT_LT(nerve, 0);
            if (nerve < -0.5e-3) EXPECT_NEAR(scan.ct.values[n], 40, 60);
        }
        if (tissue == MolarTissue::kPulp || tissue == MolarTissue::kDentine ||
            tissue == MolarTissue::kEnamel) {
            EXPECT_LT(third, 0);
        }
        if (tissue == MolarTissue::kLingualPlate) EXPECT_LT(p_W.x(), 0);
        auto& [sum, count] = hu[tissue];
        sum += scan.ct.values[n];
        ++count;
    });
    EXPECT_EQ(voxels.size(), 7u);
    const double voxel_mm3 = 0.3 * 0.3 * 0.3;
    const double tooth_mm3 = voxel_mm3 * double(voxels[MolarTissue::kEnamel] + voxels[MolarTissue::kDentine] +
                                                voxels[MolarTissue::kPulp]);
    EXPECT_GT(tooth_mm3, 500);
    EXPECT_LT(tooth_mm3, 1200);
    const double nerve_mm3 = voxel_mm3 * double(voxels[MolarTissue::kNerve]);
    const double per_mm = std::numbers::pi * 1.05 * 1.05;  // of a nerve of 2.1 mm
    EXPECT_GT(nerve_mm3, 30 * per_mm);
    EXPECT_LT(nerve_mm3, 45 * per_mm);
    const auto mean = [&](MolarTissue tissue) { return hu[tissue].first / hu[tissue].second; };
    EXPECT_GT(mean(MolarTissue::kEnamel), 2000);
    EXPECT_NEAR(mean(MolarTissue::kDentine), 1550, 250);
    EXPECT_GT(mean(MolarTissue::kLingualPlate), 900);
}

TEST(ThirdMolar, IsThatOfItsSeedAndMirroredOnTheRight) {
    ThirdMolarKind kind = molarKind(3, Impaction::kMiddle);
    const ThirdMolar left(kind), again(kind), other(molarKind(4, Impaction::kMiddle));
    const VolumeGeometry grid = left.grid(0.8e-3);
    const MolarScan l = left.scan(grid);
    EXPECT_EQ(l.ct.values, again.scan(grid).ct.values);
    EXPECT_NE(l.labels, other.scan(grid).labels);
    kind.is_right = true;
    const ThirdMolar right(kind);
    const MolarScan r = right.scan(right.grid(0.8e-3));
    size_t differing = 0;
    forEachIndex({Vector3i::Zero(), (grid.dims.array() - 1).matrix()}, [&](const Vector3i& v) {
        const size_t n = placeIn(grid.dims, v),
                     m = placeIn(grid.dims, {grid.dims.x() - 1 - v.x(), v.y(), v.z()});
        differing += std::abs(l.ct.values[n] - r.ct.values[m]) > 1 || l.labels[n] != r.labels[m];
    });
    EXPECT_LT(differing, 20u) << "where rounding decides";
}

}  // namespace
}  // namespace bonemill

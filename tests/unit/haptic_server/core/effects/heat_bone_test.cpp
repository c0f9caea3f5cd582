// The heat grid's idea of the bone, kept up to date where it was cut, is that of one that looks everywhere.
#include <gtest/gtest.h>

#include <random>

#include "haptic_server/core/effects/thermal/heat_grid.h"
#include "tests/support/full_block.h"
#include "tests/support/typical_effects.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kPeriod = 1e-3;

void expectSame(const HeatGrid& noted, const HeatGrid& looking, const VoxelVolume& bone) {
    forEachIndex({Vector3i::Zero(), bone.dims().array() - 1}, [&](const Vector3i& voxel) {
        const Vector3d place = bone.spacing().cwiseProduct(voxel.cast<double>());
        ASSERT_EQ(noted.temperatureAt(place), looking.temperatureAt(place)) << voxel.transpose();
    });
}

// Cubes are finer or coarser than voxels, and there are no more bricks than are looked up in a step.
class HeatBone : public testing::TestWithParam<double> {};

TEST_P(HeatBone, IsThatOfTheVoxelsAfterEachCut) {
    std::mt19937 random(7);
    const Vector3d spacing = GetParam() * Vector3d(1, 0.9, 1.2);
    const Vector3i dims = (Vector3d(7.9e-3, 3.9e-3, 3.9e-3).array() / spacing.array()).cast<int>();
    VoxelVolume bone = test::fullBlock(dims, spacing);
    HeatConfig config = test::kHeat;
    config.cell = 0.5e-3;
    HeatGrid noted(config, bone, kPeriod), looking(config, bone, kPeriod);
    const auto drawn = [&](int below) { return std::uniform_int_distribution<int>(0, below - 1)(random); };
    for (int cut = 0; cut < 60; ++cut) {
        const Vector3i first(drawn(dims.x()), drawn(dims.y()), drawn(dims.z()));
        const Vector3i last =
            (first + Vector3i(drawn(4), drawn(4), drawn(4))).cwiseMin(dims - Vector3i::Ones());
        forEachIndex({first, last}, [&](const Vector3i& v) {
            bone.set(v.x(), v.y(), v.z(), cut % 5 == 4 ? kMaxDensity : 0);
        });
        const Vector3d place =
            bone.spacing().cwiseProduct(Vector3d(drawn(dims.x()), drawn(dims.y()), drawn(dims.z())));
        for (HeatGrid* heat : {&noted, &looking}) {
            if (heat == &noted)
                heat->noteChange({first, last});
            else
                heat->noteChangeEverywhere();
            heat->addHeat(place, -Vector3d::UnitZ(), 2e-5);
            for (int n = 0; n < 40; ++n) heat->step();
        }
        expectSame(noted, looking, bone);
    }
    EXPECT_GT(noted.hottest(), config.body_temperature + 0.01);
}

INSTANTIATE_TEST_SUITE_P(VoxelsOf, HeatBone, testing::Values(0.15e-3, 0.3e-3, 0.45e-3));

TEST(HeatBoneOfASliver, HasNone) {
    const VoxelVolume sliver =
        test::fullBlock({1, 8, 8}, {0.1e-3, 0.3e-3, 0.3e-3});  // no cube's middle is in it
    HeatConfig config = test::kHeat;
    config.cell = 0.5e-3;
    HeatGrid heat(config, sliver, kPeriod);
    heat.addHeat({0, 1e-3, 1e-3}, Vector3d::UnitX(), 1e-3);
    for (int n = 0; n < 100; ++n) heat.step();
    EXPECT_EQ(heat.hottest(), config.body_temperature);
}

}  // namespace
}  // namespace bonemill

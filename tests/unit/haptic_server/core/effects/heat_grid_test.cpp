#include "haptic_server/core/effects/thermal/heat_grid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/geometry/pose.h"
#include "tests/support/full_block.h"
#include "tests/support/typical_effects.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kSpacing = 0.5e-3;
constexpr double kDt = 1e-3;
constexpr double kBody = 37;

// Neither surface nor blood takes heat.
HeatConfig insulated() {
    HeatConfig config = test::kHeat;
    config.wet_transfer = config.dry_transfer = 0;
    return config;
}
double diffusivity(const HeatConfig& config) {
    return config.conductivity / config.heat_capacity;
}

VoxelVolume boneOf(const Eigen::Vector3i& dims, double spacing = kSpacing) {
    return test::fullBlock(dims, Vector3d::Constant(spacing));
}

void run(HeatGrid& heat, double seconds, double dt = kDt) {
    for (int n = int(std::lround(seconds / dt)); n > 0; --n) heat.step();
}

const Vector3d kUp = Vector3d::UnitZ();
// Returns the middle of a cube's voxel.
Vector3d cubeAt(int i, int j, int k) {
    return kSpacing * Vector3d(i, j, k);
}

TEST(HeatGrid, NothingIsThereBeforeTheFirstHeat) {
    const VoxelVolume bone = boneOf({40, 40, 40});
    HeatGrid heat(test::kHeat, bone, kDt);
    run(heat, 0.1);
    EXPECT_EQ(heat.activeBricks(), 0u);
    EXPECT_EQ(heat.hottest(), kBody);
    EXPECT_EQ(heat.necroticVolume(), 0);
}

TEST(HeatGrid, HeatIsConserved) {
    const VoxelVolume bone = boneOf({48, 48, 48});
    HeatGrid heat(insulated(), bone, kDt);
    double put_in = 0;
    for (int n = 0; n < 3000; ++n) {  // a source that moves across bricks
        heat.addHeat(cubeAt(12 + n / 150, 15 + n / 300, 24), -kUp, 2e-3);
        put_in += 2e-3;
        heat.step();
    }
    EXPECT_NEAR(heat.storedHeat() / put_in, 1, 1e-3);
    run(heat, 5);
    EXPECT_NEAR(heat.storedHeat() / put_in, 1, 1e-2);
    EXPECT_GT(heat.activeBricks(), 8u);
}

// The temperature is Q / (ρc (4πατ)^(3/2)) exp(-r² / 4ατ) (Carslaw and Jaeger).
TEST(HeatGrid, PointSourceSpreadsAsInTheInfiniteMedium) {
    const VoxelVolume bone = boneOf({64, 64, 64});
    const HeatConfig config = insulated();
    HeatGrid heat(config, bone, kDt);
    constexpr double kHeat = 1;  // J
    heat.addHeat(cubeAt(32, 32, 32), Vector3d::Zero(), kHeat);
    // A heap of heat in one cube is a point only when it has spread over many: the error falls as 1 / time.
    for (const double seconds : {8.0, 16.0}) {
        run(heat, seconds - heat.time());
        const double spread = 4 * diffusivity(config) * seconds;
        const double peak = kHeat / (config.heat_capacity * std::pow(M_PI * spread, 1.5));
        for (const Eigen::Vector3i& away :
             {Eigen::Vector3i(0, 0, 0), {2, 0, 0}, {0, -3, 0}, {0, 0, 4}, {-2, 2, 2}}) {
            const double r = kSpacing * away.cast<double>().norm();
            const double expected = peak * std::exp(-r * r / spread);
            const double excess =
                heat.temperatureAt(cubeAt(32 + away.x(), 32 + away.y(), 32 + away.z())) - kBody;
            EXPECT_NEAR(excess, expected, 0.35 / seconds * peak)
                << away.transpose() << " after " << seconds << " s";
        }
    }
}

// A surface heated by q W/m² is warmer by q √(4ατ/π) / k, which falls off with depth as ierfc (Carslaw
// and Jaeger).
TEST(HeatGrid, SurfaceHeatedEvenlyWarmsAsAHalfSpace) {
    const VoxelVolume bone = boneOf({8, 8, 64});
    const HeatConfig config = insulated();
    HeatGrid heat(config, bone, kDt);
    constexpr double kFlux = 1e4;  // W/m²
    constexpr double kSeconds = 6;
    for (int n = 0; n < int(kSeconds / kDt); ++n) {
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j)
                heat.addHeat(cubeAt(i, j, 63), -kUp, kFlux * kSpacing * kSpacing * kDt);
        heat.step();
    }
    const double length = std::sqrt(4 * diffusivity(config) * kSeconds);
    const auto expected = [&](double depth) {
        const double x = depth / length;
        return kFlux * length / config.conductivity * (std::exp(-x * x) / std::sqrt(M_PI) - x * std::erfc(x));
    };
    for (const int deep : {0, 2, 4, 6}) {
        const double excess = heat.temperatureAt(cubeAt(3, 4, 63 - deep)) - kBody;
        EXPECT_NEAR(excess, expected((deep + 0.5) * kSpacing), 0.03 * expected(0)) << deep;
    }
}

TEST(HeatGrid, TheResultDoesNotDependOnTheTickRate) {
    const VoxelVolume bone = boneOf({40, 40, 40});
    std::vector<double> excess;
    for (const double dt : {4e-3, 1e-3, 0.25e-3}) {
        HeatConfig config = test::kHeat;
        HeatGrid heat(config, bone, dt);
        heat.irrigate(cubeAt(20, 20, 39), 5e-3, cubeAt(20, 20, 60));
        // Heat comes in each step and goes on when its brick has its turn: the mean of many turns counts.
        double sum = 0;
        const int steps = int(std::lround(2 / dt)), last = steps / 2;
        for (int n = 0; n < steps; ++n) {
            const double before = heat.hottest();
            heat.addHeat(cubeAt(20, 20, 39), -kUp, 0.3 * dt);
            heat.step();
            if (n >= steps - last) sum += (before + heat.hottest()) / 2 - kBody;
        }
        excess.push_back(sum / last);
    }
    EXPECT_GT(excess[1], 5);
    EXPECT_NEAR(excess[0] / excess[1], 1, 0.02);
    EXPECT_NEAR(excess[2] / excess[1], 1, 0.02);
}

// Flux q on a surface that water of T_0 cools with h settles at T_0 + q / h, whatever the cubes are.
TEST(HeatGrid, AWetSurfaceUnderFluxSettlesAsItsFilmDoes) {
    constexpr double kFlux = 3e4;  // W/m²
    for (const double cell : {0.25e-3, 0.5e-3, 1e-3}) {
        constexpr int kTop = 15;
        const VoxelVolume bone = boneOf({8, 8, kTop + 1}, cell);
        HeatConfig config = test::kHeat;
        config.cell = cell;
        config.dry_transfer = 0;
        HeatGrid heat(config, bone, kDt);
        const auto at = [&](double i, double j, double k) { return Vector3d(cell * Vector3d(i, j, k)); };
        // The ball of water touches the top alone.
        heat.irrigate(at(3.5, 3.5, kTop + 40), 40.4 * cell, at(3.5, 3.5, kTop + 60));
        for (int n = 0; n < int(8 / kDt); ++n) {
            for (int i = 0; i < 8; ++i)
                for (int j = 0; j < 8; ++j) heat.addHeat(at(i, j, kTop), -kUp, kFlux * cell * cell * kDt);
            heat.step();
        }
        const double expected = config.irrigation_temperature + kFlux / config.wet_transfer;
        EXPECT_NEAR(heat.temperatureAt(at(4, 4, kTop)), expected, 2) << cell;
    }
}

// Cold water cools bone that nothing has warmed, as it does a half-space (Carslaw and Jaeger).
TEST(HeatGrid, WaterCoolsBoneThatNothingHasWarmed) {
    const VoxelVolume bone = boneOf({40, 40, 40});
    const HeatConfig config = test::kHeat;
    HeatGrid heat(config, bone, kDt);
    heat.irrigate(cubeAt(20, 20, 39), 5e-3, cubeAt(20, 20, 60));
    constexpr double kSeconds = 5;
    run(heat, kSeconds);
    const double h_k = config.wet_transfer / config.conductivity, depth = config.cell / 2;
    const double length = std::sqrt(diffusivity(config) * kSeconds);
    const double left = std::erf(depth / (2 * length)) + std::exp(h_k * depth + h_k * h_k * length * length) *
                                                             std::erfc(depth / (2 * length) + h_k * length);
    const double expected = config.irrigation_temperature + (kBody - config.irrigation_temperature) * left;
    ASSERT_LT(expected, 33);
    EXPECT_NEAR(heat.temperatureAt(cubeAt(20, 20, 39)), expected, 1);
    EXPECT_NEAR(heat.temperatureAt(cubeAt(2, 2, 2)), kBody, 0.1);
}

// A plate of 4 mm cools by its area, not by that of its stairs.
TEST(HeatGrid, TheStairsOfASlopeCoolAsTheSlopeDoes) {
    const auto ratePerS = [](const Vector3d& normal) {
        constexpr int kSide = 48;
        constexpr double kHalf = 2e-3, kRadius = 10e-3;
        VoxelVolume bone = boneOf(Eigen::Vector3i::Constant(kSide));
        const Vector3d middle = Vector3d::Constant((kSide - 1) / 2.0 * kSpacing);
        bone.fill([&](int i, int j, int k) {
            const Vector3d p = kSpacing * Vector3d(i, j, k) - middle;
            return std::abs(p.dot(normal)) < kHalf && p.norm() < kRadius ? kMaxDensity : Density(0);
        });
        HeatConfig config = insulated();
        config.dry_transfer = 1000;
        HeatGrid heat(config, bone, kDt);
        const Eigen::Quaterniond turn = rotationBetween(kUp, normal);
        for (const double side : {-1.0, 1.0})
            for (int i = -18; i <= 18; ++i)
                for (int j = -18; j <= 18; ++j) {
                    const Vector3d across(i * kSpacing, j * kSpacing, 0);
                    if (across.norm() > kRadius) continue;
                    heat.addHeat(middle + turn * (across + side * kHalf * kUp), -side * normal, 5e-3);
                    heat.step();
                }
        run(heat, 1);
        const double before = heat.storedHeat();
        run(heat, 1);
        return std::log(before / heat.storedHeat());
    };
    const double flat = ratePerS(kUp);
    EXPECT_GT(flat, 0.15);
    EXPECT_NEAR(ratePerS(Vector3d(1, 0, 1).normalized()) / flat, 1, 0.1);
    EXPECT_NEAR(ratePerS(Vector3d(1, 1, 1).normalized()) / flat, 1, 0.1);
}

TEST(HeatGrid, BloodTakesItsShare) {
    const VoxelVolume bone = boneOf({32, 32, 32});
    HeatConfig config = insulated();
    config.perfusion = 0.2;
    HeatGrid heat(config, bone, kDt);
    heat.addHeat(cubeAt(16, 16, 16), -kUp, 1);
    run(heat, 5);
    EXPECT_NEAR(heat.storedHeat(), std::exp(-0.2 * 5), 0.01);
}

// A thin plate is as warm inside as outside: it cools as exp(-2 h τ / (ρc d)).
TEST(HeatGrid, IrrigatedPlateCoolsTowardsTheWater) {
    const VoxelVolume bone = boneOf({16, 16, 1});
    HeatConfig config = insulated();
    config.wet_transfer = 100;
    config.irrigation_temperature = 30;
    HeatGrid heat(config, bone, kDt);
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j)
            heat.addHeat(cubeAt(i, j, 0), -kUp, 10 * config.heat_capacity * std::pow(kSpacing, 3));
    heat.irrigate(cubeAt(8, 8, 0), 1, cubeAt(8, 8, 20));
    constexpr double kSeconds = 3;
    run(heat, kSeconds);
    const double transfer = 1 / (1 / config.wet_transfer + kSpacing / 2 / config.conductivity);
    const double rate = 2 * transfer / (config.heat_capacity * kSpacing);
    // The middle of the plate is compared: its rim has more surface.
    EXPECT_NEAR(heat.temperatureAt(cubeAt(8, 8, 0)), 30 + 17 * std::exp(-rate * kSeconds), 0.1);
    heat.irrigate(cubeAt(8, 8, 0), 0, cubeAt(8, 8, 20));
    const double before = heat.temperatureAt(cubeAt(8, 8, 0));
    run(heat, 1);
    EXPECT_NEAR(heat.temperatureAt(cubeAt(8, 8, 0)), before, 0.05);
}

// The water comes from above, aslant: the open face gets it, the bottom of a deep slot and the far side do
// not.
TEST(HeatGrid, CoolantWetsOnlyWhatItReaches) {
    VoxelVolume bone = boneOf({40, 40, 20});
    for (int j = 0; j < 40; ++j)
        for (int k = 8; k < 20; ++k) bone.set(20, j, k, 0);
    HeatConfig config = insulated();
    config.wet_transfer = 3000;
    HeatGrid heat(config, bone, kDt);
    const Vector3d places[] = {cubeAt(10, 20, 19), cubeAt(20, 20, 7), cubeAt(20, 20, 0)};
    const Vector3d inward[] = {-kUp, -kUp, kUp};
    for (int n = 0; n < 3; ++n) heat.addHeat(places[n], inward[n], 2e-3);
    double before[3], after[3];
    for (int n = 0; n < 3; ++n) before[n] = heat.temperatureAt(places[n]);
    heat.irrigate(cubeAt(20, 20, 10), 20e-3, cubeAt(0, 20, 40));
    run(heat, 0.3);
    for (int n = 0; n < 3; ++n) after[n] = heat.temperatureAt(places[n]);
    EXPECT_GT(before[0], 40);
    EXPECT_LT(after[0], 35.5);
    EXPECT_GT(after[1], kBody + 0.5);
    EXPECT_GT(after[2], kBody + 0.5);
    // From above, and from so far that to walk there would take years.
    heat.irrigate(cubeAt(20, 20, 10), 20e-3, cubeAt(20, 20, 20) + 1e9 * kUp);
    run(heat, 1);
    EXPECT_LT(heat.temperatureAt(places[1]), 35);
}

TEST(HeatGrid, WhatIsCutAwayIsNeitherHotNorDeadBone) {
    VoxelVolume bone = boneOf({32, 32, 32});
    HeatConfig config = insulated();
    HeatGrid heat(config, bone, kDt);
    heat.addHeat(cubeAt(16, 16, 16), -kUp, 20e-3);
    run(heat, 0.03);
    EXPECT_GT(heat.hottest(), 60);
    EXPECT_GT(heat.necroticVolume(), 0);
    for (int k = 12; k <= 20; ++k)
        for (int j = 12; j <= 20; ++j)
            for (int i = 12; i <= 20; ++i) bone.set(i, j, k, 0);
    heat.noteChange({{12, 12, 12}, {20, 20, 20}});
    run(heat, 0.1);
    EXPECT_LT(heat.hottest(), kBody + 0.1);
    EXPECT_EQ(heat.necroticVolume(), 0);
}

// Its brick was closed long ago when the whole bone becomes another one.
TEST(HeatGrid, DeadBoneThatIsGoneDoesNotCountThoughItIsCold) {
    VoxelVolume bone = boneOf({32, 32, 32});
    HeatGrid heat(test::kHeat, bone, kDt);
    heat.addHeat(cubeAt(10, 10, 10), -kUp, test::kHeat.heat_capacity * std::pow(kSpacing, 3) * 10.5);
    run(heat, 20);
    EXPECT_EQ(heat.activeBricks(), 0u);
    EXPECT_GT(heat.necroticVolume(), 0);
    for (int k = 0; k < 32; ++k)
        for (int j = 0; j < 32; ++j)
            for (int i = 0; i < 16; ++i) bone.set(i, j, k, 0);
    heat.noteChangeEverywhere();
    run(heat, 0.1);
    EXPECT_EQ(heat.necroticVolume(), 0);
}

// A burr that cuts among dead bone makes all of it stale in every tick. No bone changes here, so that the
// notes may change nothing either, but for when a brick has its turn.
TEST(HeatGrid, HeatSpreadsWhileDeadBoneIsLookedUpAgain) {
    const VoxelVolume bone = boneOf({32, 32, 32});
    HeatGrid undisturbed(insulated(), bone, kDt), noted(insulated(), bone, kDt);
    for (HeatGrid* heat : {&undisturbed, &noted}) {
        for (int n = 0; n < 8; ++n)  // one cube in each of the eight bricks that meet here
            heat->addHeat(cubeAt(15 + (n & 1), 15 + (n >> 1 & 1), 15 + (n >> 2)), Vector3d::Zero(), 5e-3);
        run(*heat, 0.1);
        EXPECT_GT(heat->necroticVolume(), 0);
        for (int n = 0; n < 500; ++n) {
            heat->addHeat(cubeAt(16, 16, 16), Vector3d::Zero(), 5e-5);
            if (heat == &noted) heat->noteChange({{15, 15, 15}, {16, 16, 16}});
            heat->step();
        }
    }
    EXPECT_NEAR((noted.hottest() - kBody) / (undisturbed.hottest() - kBody), 1, 0.02);
    EXPECT_NEAR(noted.storedHeat() / undisturbed.storedHeat(), 1, 1e-3);
}

// Cubes count once however often they are heated, also after their brick was given up meanwhile.
TEST(HeatGrid, NecrosisIsCountedOnce) {
    const VoxelVolume bone = boneOf({32, 32, 32});
    HeatGrid heat(test::kHeat, bone, kDt);
    const double cube = std::pow(kSpacing, 3);
    const double ten_kelvin = test::kHeat.heat_capacity * cube * 10.5;
    for (int n = 0; n < 3; ++n) {
        heat.addHeat(cubeAt(10, 10, 10), -kUp, ten_kelvin);
        run(heat, 20);
        EXPECT_EQ(heat.activeBricks(), 0u);
        EXPECT_NEAR(heat.necroticVolume(), cube, 1e-6 * cube);
    }
}

TEST(HeatGrid, NecrosisCanNeedItsTime) {
    const VoxelVolume bone = boneOf({32, 32, 32});
    HeatConfig config = insulated();
    config.necrosis_time = 2;
    HeatGrid heat(config, bone, kDt);
    // All of the bone is 15 K warmer.
    for (int k = 0; k < 32; ++k)
        for (int j = 0; j < 32; ++j)
            for (int i = 0; i < 32; ++i) {
                heat.addHeat(cubeAt(i, j, k), Vector3d::Zero(),
                             config.heat_capacity * std::pow(kSpacing, 3) * 15);
                if (i % 8 == 0 && j % 8 == 0 && k % 8 == 0) heat.step();  // opens few bricks at a time
            }
    run(heat, 1.5);
    EXPECT_EQ(heat.necroticVolume(), 0);
    run(heat, 1);
    EXPECT_NEAR(heat.necroticVolume() / std::pow(32 * kSpacing, 3), 1, 0.01);
}

// However much is hot, the number of bricks is bounded.
TEST(HeatGrid, BricksAreBounded) {
    const VoxelVolume bone = boneOf({128, 128, 64});
    HeatGrid heat(insulated(), bone, kDt);
    for (int n = 0; n < 2000; ++n) {
        heat.addHeat(cubeAt(8 * (n % 16), 8 * (n / 16 % 16), 8 * (n / 256)), Vector3d::Zero(), 0.1);
        heat.step();
    }
    EXPECT_GT(heat.activeBricks(), 500u);
    EXPECT_LE(heat.activeBricks(), 1024u);  // of the 2000 that were heated
    EXPECT_TRUE(std::isfinite(heat.hottest()));
}

}  // namespace
}  // namespace bonemill

// A burr that removes by time takes what its rate allows, whatever the tick, the voxels and the hand.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/milling_rig.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::MillingRig;
using test::RigConfig;

RigConfig timed(double rate_per_s) {
    RigConfig config;
    config.size = {9e-3, 4e-3, 4e-3};
    config.surface = 2.6e-3;
    config.burr.radius = 1e-3;
    config.time_removal = TimeRemovalConfig{.rate = rate_per_s * kDensityCountsPerUnit};
    return config;
}

// The rate makes the burr remove at this speed, m/s.
double speedOf(const RigConfig& config) {
    return 2 * config.burr.radius * config.time_removal->rate / kMaxDensity;
}

constexpr double kDepth = 0.6e-3, kWay = 5e-3;  // m: of a groove

// The hand leads the burr down into the bone within 0.1 s, and along x at `speed`.
void makeGroove(MillingRig& rig, double speed) {
    constexpr double kSink = 0.1;  // s
    const Vector3d top = rig.center() + Vector3d(-kWay / 2, 0, rig.config.burr.radius);
    rig.feed(kSink, top, {0, 0, -kDepth / kSink});
    const double time = kWay / speed;
    rig.run(time + 0.02, top, [=, begin = rig.records.back().t_s](double t, const Vector3d&) {
        return Vector3d(top + Vector3d(std::min(kWay, speed * (t - begin)), 0, -kDepth));
    });
}

// The surface lies a little outside of the burr that cut it (milling/burr_limit.h).
double sweptByGroove(const RigConfig& config) {
    const double outside = config.spacing.squaredNorm() / (14 * config.burr.radius);
    const double r = config.burr.radius + outside, depth = kDepth + outside, up = r - depth;
    const double section = r * r * std::acos(up / r) - up * std::sqrt(r * r - up * up);
    return section * kWay + M_PI * depth * depth * (3 * r - depth) / 3;
}

TEST(TimeRemoval, AQuickHandTakesWhatItSweepsAtAnyRateOfTheLoop) {
    double slowest = 0;
    for (const double rate : {500.0, 1000.0, 4000.0, 10000.0}) {
        RigConfig config = timed(12750);  // the default: 100 mm/s
        config.rate = rate;
        MillingRig rig(config);
        makeGroove(rig, 50e-3);
        if (slowest == 0) slowest = rig.removedVolume();
        EXPECT_NEAR(rig.removedVolume() / slowest, 1, 0.005) << rate;
        EXPECT_NEAR(rig.removedVolume() / sweptByGroove(config), 1, 0.02) << rate;
        EXPECT_LT(rig.largestLag(), 0.06e-3) << rate;  // what the coupling's damping makes at that speed
    }
}

TEST(TimeRemoval, TakesWhatItSweepsWhateverTheVoxels) {
    for (const double voxel : {0.1e-3, 0.2e-3}) {
        RigConfig config = timed(12750);
        config.spacing.setConstant(voxel);
        MillingRig rig(config);
        makeGroove(rig, 50e-3);
        EXPECT_NEAR(rig.removedVolume() / sweptByGroove(config), 1, 0.025) << voxel;
    }
}

// A hand that is faster than the burr can remove hardly drives it any faster, however hard it pushes.
TEST(TimeRemoval, GoesAtItsOwnSpeedUnderAnyForce) {
    for (const double force : {1.0, 4.0}) {
        double first = 0;
        for (const double rate : {500.0, 4000.0})
            for (const double voxel : {0.125e-3, 0.2e-3}) {
                RigConfig config = timed(300);
                config.rate = rate;
                config.spacing.setConstant(voxel);
                config.size = {4e-3, 4e-3, 4e-3};
                MillingRig rig(config);
                const Vector3d top = rig.center() + Vector3d(0, 0, config.burr.radius);
                rig.press(0.5, top, -Vector3d::UnitZ(), force);
                const TickRecord &begin = rig.records[rig.records.size() / 2], &end = rig.records.back();
                const double feed = (begin.p_WT[2] - end.p_WT[2]) / (end.t_s - begin.t_s);
                if (first == 0) first = feed;
                EXPECT_NEAR(feed / first, 1, 0.02) << rate << ' ' << voxel << ' ' << force;
                EXPECT_NEAR(feed / speedOf(config), 1.08, 0.07) << rate << ' ' << voxel << ' ' << force;
            }
    }
}

// Spacings as of a coarse tomography, in millimetres, and burrs about as large as such a voxel or smaller.
const std::vector<Vector3d> kCoarse = {{1, 1, 1}, {0.4, 0.4, 1.2}, {1.2, 0.4, 0.4}, {0.957, 0.957, 1.5}};
constexpr double kRadiiInVoxels[] = {0.3, 0.67, 1, 1.5};
constexpr double kCoarseSpeed = 10e-3;  // m/s: of the burr at its rate

RigConfig coarse(const Vector3d& spacing_mm, double radius_in_voxels) {
    const double voxel = spacing_mm.maxCoeff() * 1e-3, radius = radius_in_voxels * voxel;
    RigConfig config = timed(255 * kCoarseSpeed / (2 * radius));
    config.spacing = spacing_mm * 1e-3;
    config.burr.radius = radius;
    config.surface = 6 * voxel + 2 * radius;
    config.size = {9 * voxel + 2 * radius, 6 * voxel + 2 * radius, config.surface + 3 * voxel};
    return config;
}

// Nothing of the bone stays in the burr that it could not cut: up to its speed the hand leads it like air.
TEST(TimeRemoval, ABurrSmallerThanAVoxelIsHeldUpByNoBone) {
    constexpr double kShareOfSpeed = 0.9, kFreeLag = 15e-6;  // m: what the coupling's damping makes, amply
    for (const Vector3d& spacing_mm : kCoarse)
        for (const double radius_in_voxels : kRadiiInVoxels)
            for (const double depth_in_radii : {0.5, 1.5}) {
                const RigConfig config = coarse(spacing_mm, radius_in_voxels);
                MillingRig rig(config);
                const double radius = config.burr.radius, depth = depth_in_radii * radius;
                const double way = 3 * config.spacing.maxCoeff(), speed = kShareOfSpeed * kCoarseSpeed;
                const Vector3d above = rig.center() + Vector3d(-way / 2, 0.21e-3, radius);
                rig.feed(depth / speed, above, {0, 0, -speed});
                rig.feed(way / speed, above - Vector3d(0, 0, depth), {speed, 0, 0});
                EXPECT_LT(rig.largestLag(), kFreeLag) << "spacing " << spacing_mm.transpose() << " mm, R/h "
                                                      << radius_in_voxels << ", depth/R " << depth_in_radii;
            }
}

// On a machine that is late a tick comes for several periods.
TEST(TimeRemoval, PeriodsWithoutATickAreNotLost) {
    double first = 0;
    for (const int periods : {1, 5}) {
        RigConfig config = timed(300);
        config.periods = periods;
        config.size = {4e-3, 4e-3, 4e-3};
        MillingRig rig(config);
        rig.press(0.5, rig.center() + Vector3d(0, 0, config.burr.radius), -Vector3d::UnitZ(), 2);
        if (first == 0) first = rig.removedVolume();
        EXPECT_NEAR(rig.removedVolume() / first, 1, 0.05) << periods;
    }
}

}  // namespace
}  // namespace bonemill

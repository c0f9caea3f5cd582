// A threshold makes of uneven pressure more removal: what is uneven by voxels and ticks must not count.
#include <gtest/gtest.h>

#include <utility>

#include "tests/support/milling_rig.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::MillingRig;
using test::RigConfig;

struct Stroke {
    double depth, sink_time, feed, feed_time;  // m, s, m/s, s
};

// m³: of a ball that sinks into a block, off the voxels' planes, and goes along.
double removedBy(const Stroke& stroke, double voxel, double rate = 1000) {
    RigConfig config;
    config.size = {7e-3, 4e-3, 3e-3};
    config.spacing.setConstant(voxel);
    config.rate = rate;
    config.rotation = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX());
    config.removal.threshold_pressure = 1e6;
    MillingRig rig(config);
    const Vector3d start = rig.center() + Vector3d(-1.469e-3, -17e-6, config.burr.radius);
    rig.feed(stroke.sink_time, start, {0, 0, -stroke.depth / stroke.sink_time});
    rig.feed(stroke.feed_time, start - Vector3d(0, 0, stroke.depth), {stroke.feed, 0, 0});
    return rig.removedVolume();
}

TEST(Threshold, DoesNotKnowVoxelsAndTicks) {
    constexpr Stroke kStroke{0.8e-3, 0.3, 2e-3, 1.5};
    const double first = removedBy(kStroke, 0.125e-3);
    ASSERT_GT(first, 0);
    for (const auto& [voxel, rate] :
         {std::pair{0.25e-3, 1000.0}, {0.125e-3, 500}, {0.125e-3, 4000}, {0.25e-3, 4000}})
        EXPECT_NEAR(removedBy(kStroke, voxel, rate) / first, 1, 0.05) << voxel << ' ' << rate;
}

// Over whole strokes, from R/h = 8 to 4: cuts as deep as some voxels hardly know them, thin ones do
// (docs/reference/effects.md).
TEST(Threshold, KnowsTheVoxelsInThinCutsOnly) {
    for (const auto& [depth, most] : {std::pair{0.8e-3, 0.05}, {0.3e-3, 0.25}}) {
        const Stroke stroke{depth, 0.15, 6e-3, 0.5};
        const double radius = RigConfig{}.burr.radius, finest = removedBy(stroke, radius / 8);
        ASSERT_GT(finest, 0);
        for (const double voxels : {6.0, 5.0, 4.0})
            EXPECT_NEAR(removedBy(stroke, radius / voxels) / finest, 1, most) << depth << ' ' << voxels;
    }
}

}  // namespace
}  // namespace bonemill

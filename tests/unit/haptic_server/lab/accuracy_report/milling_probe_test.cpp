#include "haptic_server/lab/accuracy_report/milling_probe.h"

#include <gtest/gtest.h>

#include "tests/support/milling_config.h"
#include "tests/unit/haptic_server/lab/accuracy_report/probe_scene.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::upright;

std::vector<Density> densitiesOf(const VoxelVolume& volume) {
    std::vector<Density> all;
    for (int k = 0; k < volume.dims().z(); ++k)
        for (int j = 0; j < volume.dims().y(); ++j)
            for (int i = 0; i < volume.dims().x(); ++i) all.push_back(volume.at(i, j, k));
    return all;
}

TEST(MillingProbe, SweptVolumeIsThatOfTheCapsuleAndTheBoneComesBack) {
    // The bone is solid all over: there is nothing to touch, and the tool follows the hand exactly but for
    // its lag.
    BoneModel bone = test::boneOf(
        test::bodyVolume(test::cubeGeometry(49, 0.125e-3), [](const Vector3d&) { return -1.0; }));
    const auto before = densitiesOf(bone.volume);
    const ToolModel tool = test::burrTool();
    BoneHistory history(bone);
    FixedTickConfig tick = test::millingConfig();
    tick.tool.model = &tool;
    tick.accuracy = presetSettings(Preset::kThesis2012);  // never held up by what it has just laid open
    tick.contact.point_stiffness = 1e-3;
    PosePath path;
    for (int n = 0; n < 900; ++n)
        path.push_back({{2e-3 + 2e-3 * std::min(1.0, n / 600.0), 3e-3, 3e-3}, upright()});
    const MillingRun run = millAndRestore(tick, bone, history, path);
    const double capsule = M_PI * 1e-9 * (4.0 / 3) + M_PI * 1e-6 * 2e-3;
    EXPECT_NEAR(run.wanted / capsule, 1, 0.01);
    EXPECT_NEAR(run.swept / capsule, 1, 0.01);
    EXPECT_NEAR(run.removed / capsule, 1, 0.1);
    EXPECT_EQ(run.records.size(), path.size());
    EXPECT_EQ(densitiesOf(bone.volume), before);
}

TEST(MillingProbe, PathGoesInAndSidewaysAtAFeedThatTheRemovalKeepsUpWith) {
    const ProbingPlace place{"", {{3e-3, 3e-3, 4e-3}, upright()}, Vector3d::UnitZ(), 0.5e-3};
    FixedTickConfig tick = test::millingConfig();
    const PosePath path = millingPath(place, tick);
    EXPECT_GE(path.size(), 3000u);
    double lowest = 1, fastest = 0;
    for (size_t n = 1; n < path.size(); ++n) {
        lowest = std::min(lowest, path[n].position.z());
        fastest = std::max(fastest, (path[n].position - path[n - 1].position).norm() / tick.dt);
    }
    EXPECT_NEAR(lowest, 4e-3 - 0.8 * test::kBurr, 1e-6);
    EXPECT_NEAR((path.back().position - place.X_WT.position).head<2>().norm(), test::kBurr, 1e-6);
    EXPECT_EQ(path.back().position, path[path.size() - 50].position);  // rests
    const double vanishing = kMaxDensity / tick.effects.time_removal->rate;
    EXPECT_LT(fastest * vanishing, 0.25 * test::kBurr);

    tick.effects.time_removal->rate /= 20;
    const PosePath slower = millingPath(place, tick);
    EXPECT_GT(slower.size(), path.size());
}

}  // namespace
}  // namespace bonemill

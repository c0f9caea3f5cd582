#include "haptic_server/lab/accuracy_report/truth.h"

#include <gtest/gtest.h>

#include "haptic_server/lab/accuracy_report/analytic_probe.h"
#include "haptic_server/lab/simulate/run_path.h"
#include "tests/unit/haptic_server/lab/accuracy_report/probe_scene.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::upright;

// The hand goes down into the floor and rests there for long.
ProbingStroke press(double depth) {
    ProbingStroke stroke{"press", {}, depth};
    for (int n = 0; n < 300; ++n) {
        const double z = 4.1e-3 - std::min(1.0, n / 200.0) * (0.1e-3 + depth);
        stroke.device.push_back({{3.02e-3, 2.97e-3, z}, upright()});
    }
    return stroke;
}

TEST(Truth, RestingBurrOnAPlaneHasTheForceAndDepthOfTheClosedForm) {
    const BoneModel bone = test::floorBone();
    const ToolModel tool = test::burrTool();
    const TouchProbe probe(bone, tool);
    const FixedTickConfig tick{{}, {&tool}, {}};
    const std::vector<ProbingStroke> strokes{press(0.4e-3), press(1.2e-3)};
    const auto truth = computeTruth(strokes, tick, bone, probe, 2);
    ASSERT_EQ(truth.size(), 2u);
    for (size_t n = 0; n < truth.size(); ++n) {
        EXPECT_EQ(truth[n].refinement, kMinRefinement);
        ASSERT_EQ(truth[n].answers.size(), strokes[n].device.size());
        const double depth = depthUnderSpring(tick, strokes[n].deepest);
        const double force = forceOnSphere(tick.gradient.contact.stiffness_per_area, test::kBurr, depth);
        const TickAnswer& rest = truth[n].answers.back();
        EXPECT_NEAR(rest.hand_W.force.z() / force, 1, 1e-3);
        EXPECT_NEAR(4e-3 - rest.X_WT.position.z(), depth, 0.3e-6);
        EXPECT_LT(rest.hand_W.force.head<2>().norm(), 2e-3 * force);
        EXPECT_EQ(truth[n].coarser.size(), truth[n].answers.size());
    }
}

TEST(Truth, CoarserVoxelsAreRefinedMore) {
    const FixedTickConfig tick;
    EXPECT_EQ(wantedRefinement(0.1e-3, tick), kMinRefinement);
    EXPECT_EQ(wantedRefinement(5e-3, tick), kMaxRefinement);
    const int refinement = wantedRefinement(0.5e-3, tick);
    EXPECT_GT(refinement, kMinRefinement);
    const double width = contactWidth(tick.gradient.contact.stiffness_per_area, test::kBurr, 1);
    EXPECT_GE(width / (0.5e-3 / refinement), 8);
    EXPECT_LT(width / (0.5e-3 / (refinement - 1)), 8);
}

// The oracle is the same run on the whole bone at that refinement.
TEST(Truth, IsThatOfTheWholeBone) {
    const Vector3d middle(3e-3, 3e-3, 2e-3);
    const BoneModel bone =
        test::boneOf(test::bodyVolume(test::cubeGeometry(49, 0.125e-3), test::sphereAt(middle, 1.8e-3)));
    const ToolModel tool = test::burrTool();
    TouchProbe probe(bone, tool);
    FixedTickConfig tick{{}, {&tool}, {}};
    const auto places = findProbingPlaces({}, bone, test::kBurr, probe);
    std::vector<ProbingStroke> strokes;
    for (const ProbingPlace& place : places)
        strokes.push_back(makeStroke(place, {.duration = 0.3}, tick, probe));
    const auto truth = computeTruth(strokes, tick, bone, probe, 2);

    BoneModel whole =
        test::boneOf(refinedPart(bone.volume, {{-1, -1, -1}, bone.volume.dims()}, kMinRefinement));
    tick.accuracy = truthSettings();
    for (size_t n = 0; n < strokes.size(); ++n) {
        const auto oracle = answersOf(runPath(tick, whole, inputsOf(strokes[n].device, tick.dt)));
        ASSERT_EQ(truth[n].answers.size(), oracle.size());
        double most_apart = 0, most_force = 0;
        for (size_t i = 0; i < oracle.size(); ++i) {
            most_apart =
                std::max(most_apart, (truth[n].answers[i].hand_W.force - oracle[i].hand_W.force).norm());
            most_force = std::max(most_force, oracle[i].hand_W.force.norm());
        }
        EXPECT_LT(most_apart, 2e-3) << strokes[n].name;
        EXPECT_GT(most_force, 1) << strokes[n].name;
    }
}

TEST(Truth, AStrokeThatTouchesNothingHasNone) {
    const BoneModel bone = test::floorBone();
    const ToolModel tool = test::burrTool();
    const TouchProbe probe(bone, tool);
    ProbingStroke stroke{"air", PosePath(10, Pose{{3e-3, 3e-3, 9e-3}, upright()}), 0};
    EXPECT_TRUE(computeTruth({stroke}, {{}, {&tool}, {}}, bone, probe, 1)[0].answers.empty());
}

}  // namespace
}  // namespace bonemill

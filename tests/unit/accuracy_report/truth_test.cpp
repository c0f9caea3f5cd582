#include "haptic_server/accuracy_report/truth.h"

#include <gtest/gtest.h>

#include "haptic_server/accuracy_report/analytic_probe.h"
#include "tests/unit/accuracy_report/probe_scene.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::upright;

// Down into the floor and a long rest.
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
    const TickConfig tick;
    const std::vector<ProbingStroke> strokes{press(0.4e-3), press(1.2e-3)};
    const auto truth = computeTruth(strokes, tick, bone, tool, probe, 2);
    ASSERT_EQ(truth.size(), 2u);
    for (size_t n = 0; n < truth.size(); ++n) {
        EXPECT_EQ(truth[n].refinement, kLeastRefinement);
        ASSERT_EQ(truth[n].answers.size(), strokes[n].device.size());
        const double depth = depthUnderSpring(tick.gradient, test::kBurr, strokes[n].deepest);
        const double force = forceOnSphere(tick.gradient.contact.stiffness_per_area, test::kBurr, depth);
        const Answer& rest = truth[n].answers.back();
        EXPECT_NEAR(rest.hand.force.z() / force, 1, 1e-3);
        EXPECT_NEAR(4e-3 - rest.spo.position.z(), depth, 0.3e-6);
        EXPECT_LT(rest.hand.force.head<2>().norm(), 2e-3 * force);
        EXPECT_EQ(truth[n].coarser.size(), truth[n].answers.size());
    }
}

TEST(Truth, CoarserVoxelsAreRefinedMore) {
    TickConfig tick;
    EXPECT_EQ(wantedRefinement(0.1e-3, tick), kLeastRefinement);
    EXPECT_EQ(wantedRefinement(5e-3, tick), kMostRefinement);
    const int refinement = wantedRefinement(0.5e-3, tick);
    EXPECT_GT(refinement, kLeastRefinement);
    const double width = contactWidth(tick.gradient.contact.stiffness_per_area, test::kBurr, 1);
    EXPECT_GE(width / (0.5e-3 / refinement), 8);
    EXPECT_LT(width / (0.5e-3 / (refinement - 1)), 8);
}

TEST(Truth, DoesNotFeelWhereItsPartOfTheBoneWasCut) {
    const BoneModel bone = test::floorBone();
    const ToolModel tool = test::burrTool();
    TouchProbe probe(bone, tool);
    const TickConfig tick;
    const ProbingPlace place{"floor", {{3e-3, 3e-3, 4e-3}, upright()}, Vector3d::UnitZ(), 0.5e-3};
    const std::vector<ProbingStroke> strokes{makeStroke(place, {}, tick, probe)};
    const auto truth = computeTruth(strokes, tick, bone, tool, probe, 1);
    // The part's cut faces would hold the tool back or push it aside: on a plane every force is straight up
    // but for the lag of the moving tool, and no deeper than 4 N press.
    double deepest = 0;
    for (const Answer& answer : truth[0].answers) deepest = std::max(deepest, 4e-3 - answer.spo.position.z());
    const double depth = depthUnderSpring(tick.gradient, test::kBurr, strokes[0].deepest);
    EXPECT_LT(deepest, depth);
    EXPECT_GT(deepest, 0.8 * depth);
    EXPECT_GT(truth[0].max_penetration, 20e-6);
}

TEST(Truth, AStrokeThatTouchesNothingHasNone) {
    const BoneModel bone = test::floorBone();
    const ToolModel tool = test::burrTool();
    const TouchProbe probe(bone, tool);
    ProbingStroke stroke{"air", PosePath(10, Pose{{3e-3, 3e-3, 9e-3}, upright()}), 0};
    EXPECT_TRUE(computeTruth({stroke}, TickConfig{}, bone, tool, probe, 1)[0].answers.empty());
}

}  // namespace
}  // namespace bonemill

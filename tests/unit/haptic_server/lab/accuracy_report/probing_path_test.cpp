#include "haptic_server/lab/accuracy_report/probing_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/haptic_server/lab/accuracy_report/probe_scene.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::upright;

TEST(SmoothPath, RestsAtBothEndsAndIsSmoothBetween) {
    const std::vector<PathKnot> knots{
        {{0, 0, 0}}, {{1, 0, 0}, {0, 0, 0.1}}, {{1, 2, 0}, {0, 0.1, 0}}, {{0, 0, 1}}, {{0, 0, 0}}};
    const PosePath path = smoothPath(upright(), knots, 1001);
    ASSERT_EQ(path.size(), 1001u);
    for (const Pose& end : {path.front(), path.back()}) {
        EXPECT_NEAR(end.position.norm(), 0, 1e-12);
        EXPECT_NEAR(logRotation(end.rotation * upright().conjugate()).norm(), 0, 1e-12);
    }
    double fastest = 0, hardest = 0;
    Vector3d last_bend = Vector3d::Zero();
    for (size_t n = 1; n + 1 < path.size(); ++n) {
        fastest = std::max(fastest, (path[n + 1].position - path[n].position).norm());
        const Vector3d bend = path[n + 1].position - 2 * path[n].position + path[n - 1].position;
        if (n > 1) hardest = std::max(hardest, (bend - last_bend).norm());
        last_bend = bend;
    }
    EXPECT_LT((path[1].position - path[0].position).norm(), fastest / 50);
    EXPECT_LT(hardest, 5e-6);  // third difference: no jump of the acceleration
    EXPECT_GT(fastest, 3e-3);
}

TEST(TouchProbe, FindsTheFloor) {
    const BoneModel bone = test::floorBone();
    const ToolModel tool = test::burrTool();
    TouchProbe probe(bone, tool);
    const Pose above{{3.03e-3, 2.98e-3, 5.5e-3}, upright()};
    const auto way = probe.freeWay(above, -Vector3d::UnitZ(), 3e-3);
    ASSERT_TRUE(way);
    EXPECT_NEAR(*way, 1.5e-3, 5e-6);  // the lowest contact point is not right below
    const Pose pressed{above.position - (*way + 20e-6) * Vector3d::UnitZ(), upright()};
    EXPECT_TRUE(probe.touches(pressed));
    EXPECT_GT(probe.pushOn(pressed).z(), 0.99);
    EXPECT_LT(probe.armOf(pressed), 0.05e-3);
    EXPECT_FALSE(probe.freeWay(above, Vector3d::UnitZ(), 3e-3));     // free all the way
    EXPECT_FALSE(probe.freeWay(pressed, -Vector3d::UnitZ(), 1e-3));  // touches at the start
    EXPECT_TRUE(probe.touches({{3e-3, 3e-3, 1e-3}, upright()}));  // all of the burr in bone, no surface near
}

TEST(TouchProbe, SurfaceNearATool) {
    const BoneModel bone = test::floorBone();
    const ToolModel tool = test::burrTool();
    const TouchProbe probe(bone, tool);
    const std::vector<Pose> path{{{3e-3, 3e-3, 4e-3}, upright()}};
    const Eigen::AlignedBox3d box = probe.surfaceNear(path, 0.3e-3);
    ASSERT_FALSE(box.isEmpty());
    EXPECT_NEAR(box.min().z(), 3e-3, 1e-6);
    EXPECT_NEAR(box.max().z(), 3e-3, 1e-6);
    const double half =
        std::sqrt(1.3e-3 * 1.3e-3 - 1e-6);  // the plane at the burr's height, inside radius + 0.3 mm
    EXPECT_NEAR(box.max().x() - 3e-3, half, 0.15e-3);
    EXPECT_TRUE(probe.surfaceNear(std::vector<Pose>{{{3e-3, 3e-3, 9e-3}, upright()}}, 0.3e-3).isEmpty());
}

scene::SimulatedOperator wayDown() {
    scene::SimulatedOperator scenario;
    for (const double z_mm : {7.0, 2.0}) {
        scene::SimulatedOperator::Waypoint& waypoint = *scenario.add_waypoint();
        waypoint.mutable_p_wt_mm()->set_x(3);
        waypoint.mutable_p_wt_mm()->set_y(3);
        waypoint.mutable_p_wt_mm()->set_z(z_mm);
        const Eigen::Quaterniond q = upright();
        waypoint.mutable_q_wt()->set_w(q.w()), waypoint.mutable_q_wt()->set_x(q.x());
        waypoint.mutable_q_wt()->set_y(q.y()), waypoint.mutable_q_wt()->set_z(q.z());
    }
    return scenario;
}

TEST(ProbingPlaces, AreOnTheScenariosWayAndBeside) {
    const BoneModel bone = test::floorBone();
    const ToolModel tool = test::burrTool();
    TouchProbe probe(bone, tool);
    const auto places = findProbingPlaces(wayDown(), bone, test::kBurr, probe);
    ASSERT_GE(places.size(), 3u);
    ASSERT_LE(places.size(), kMaxPlaces);
    EXPECT_NEAR(places[0].X_WT.position.x(), 3e-3, 1e-9);
    EXPECT_NEAR(places[0].X_WT.position.z(), 4e-3, 5e-6);
    for (const ProbingPlace& place : places) {
        EXPECT_FALSE(probe.touches(place.X_WT)) << place.name;
        EXPECT_TRUE(probe.touches({place.X_WT.position - 10e-6 * place.normal_W, place.X_WT.rotation}))
            << place.name;
        EXPECT_GT(place.room, 0.1e-3);
    }
}

TEST(ProbingPlaces, WithoutAScenarioTheToolComesFromTheFaces) {
    const Vector3d middle = Vector3d::Constant(3e-3);
    const BoneModel bone =
        test::boneOf(test::bodyVolume(test::cubeGeometry(49, 0.125e-3), test::sphereAt(middle, 2e-3)));
    const ToolModel tool = test::burrTool();
    TouchProbe probe(bone, tool);
    const auto places = findProbingPlaces({}, bone, test::kBurr, probe);
    ASSERT_FALSE(places.empty());
    const Vector3d outward = (places[0].X_WT.position - middle).normalized();
    EXPECT_NEAR((places[0].X_WT.position - middle).norm(), 3e-3, 20e-6);
    EXPECT_GT(places[0].normal_W.dot(outward), 0.99);
    EXPECT_GT((places[0].X_WT.rotation * Vector3d::UnitY()).dot(outward), 0.99);  // the shaft points away
    bool has_shaft_place = false;
    for (const ProbingPlace& place : places) {
        const Pose pushed{place.X_WT.position - 20e-6 * place.normal_W, place.X_WT.rotation};
        has_shaft_place |= probe.armOf(pushed) > 2 * test::kBurr;
    }
    EXPECT_TRUE(has_shaft_place);
}

TEST(ProbingPlaces, NoneInAir) {
    const BoneModel bone = test::boneOf(VoxelVolume(test::cubeGeometry(20, 0.125e-3), test::kTestIso));
    const ToolModel tool = test::burrTool();
    TouchProbe probe(bone, tool);
    EXPECT_TRUE(findProbingPlaces(wayDown(), bone, test::kBurr, probe).empty());
}

TEST(ProbingStroke, IsClosedStartsFreeAndPresses) {
    const BoneModel bone = test::floorBone();
    const ToolModel tool = test::burrTool();
    TouchProbe probe(bone, tool);
    const ProbingPlace place{"floor", {{3e-3, 3e-3, 4e-3}, upright()}, Vector3d::UnitZ(), 0.5e-3};
    FixedTickConfig tick;
    const ProbingStroke stroke = makeStroke(place, {}, tick, probe);
    EXPECT_NEAR((stroke.device.front().position - stroke.device.back().position).norm(), 0, 1e-12);
    EXPECT_FALSE(probe.touches(stroke.device.front()));
    double deepest = 0, widest = 0;
    for (const Pose& pose : stroke.device) {
        deepest = std::max(deepest, 4e-3 - pose.position.z());
        widest = std::max(widest, (pose.position - place.X_WT.position).head<2>().norm());
    }
    // The coupling is stretched by 4 N at 3 N/mm; the spline cuts the corners of its knots.
    EXPECT_NEAR(stroke.deepest, stretchOf(tick.toolCoupling(), 4), 1e-9);
    EXPECT_NEAR(deepest, stroke.deepest, 0.15e-3);
    EXPECT_NEAR(widest, 1.1e-3, 0.2e-3);
}

TEST(Stretch, IsTheInverseOfTheSaturatingSpring) {
    EnergyCoupling coupling;
    coupling.saturation_force = 8;
    const double stretch = stretchOf(coupling, 5);
    EXPECT_NEAR(8 * std::tanh(coupling.translation_stiffness * stretch / 8), 5, 1e-12);
}

}  // namespace
}  // namespace bonemill

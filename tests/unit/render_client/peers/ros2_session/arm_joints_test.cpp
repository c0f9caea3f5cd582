#include "render_client/peers/ros2_session/arm_joints.h"

#include <gtest/gtest.h>

namespace bonemill::ros2 {
namespace {

using Eigen::Vector3d;

constexpr double kScale = 2.5;

scene::Device device() {
    scene::Device device;
    device.set_workspace_scale(kScale);
    return device;
}
Pose base() {
    return {{0.3, -0.2, 0.1}, Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()))};
}
// What the forward kinematics make of the sliders, as a session tells it.
Pose handAt(const Vector6d& sliders) {
    const ForwardSolution found = AresKinematics().forward(sliders, {});
    EXPECT_TRUE(found.converged);
    return base() * HandSpace(kScale).poseAtTool(found.X_DT);
}
Vector6d sliders(double shift) {
    Vector6d q;
    q << 0.071, 0.082, 0.069, 0.077, 0.08, 0.073;
    return q.array() + shift;
}

TEST(AresArm, HasTheSlidersThatLeadToTheHandsPose) {
    const auto joints = AresArm(device(), base()).jointsAt(handAt(sliders(0)), {});
    ASSERT_TRUE(joints);
    EXPECT_LT((joints->positions - sliders(0)).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_FALSE(joints->velocities);
}

TEST(AresArm, SlidersMoveAsTheirPositionsDo) {
    constexpr double kStep = 1e-6;
    Vector6d speed;
    speed << 0.01, -0.02, 0.03, 0.015, -0.005, 0.02;
    const Pose before = handAt(sliders(0) - kStep * speed), after = handAt(sliders(0) + kStep * speed);
    const AresArm::Motion motion{(after.position - before.position) / (2 * kStep),
                                 logRotation(after.rotation * before.rotation.conjugate()) / (2 * kStep)};
    const auto joints = AresArm(device(), base()).jointsAt(handAt(sliders(0)), motion);
    ASSERT_TRUE(joints && joints->velocities);
    EXPECT_LT((*joints->velocities - speed).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(AresArm, SaysNothingOfAPoseThatNoLinkReaches) {
    EXPECT_FALSE(AresArm(device(), base()).jointsAt(base() * Pose{{2, 0, 0}, base().rotation}, {}));
}

}  // namespace
}  // namespace bonemill::ros2

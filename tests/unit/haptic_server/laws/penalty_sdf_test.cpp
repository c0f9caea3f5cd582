#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/unit/haptic_server/laws/law_scene.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

PenaltySdf& penaltyOf(LawRun& run) {
    return static_cast<PenaltySdf&>(run.model);
}

// Barbič and James: the stiffness matrix is the exact derivative of force and torque by the tool's pose. A
// capsule that leans on a plane has contacts with levers; points that enter or leave would be no derivative,
// so that the steps are short.
TEST(PenaltySdf, StiffnessIsTheDerivativeOfTheWrench) {
    const std::vector<ToolShape> shapes{CapsuleShape{{0, 0, 0}, {0, 1.6e-3, 0}, 0.6e-3}};
    const ContactScene scene(cubeGeometry(41, kLawVoxel), halfSpace(kLawMiddle, {0, 0, 1}), shapes,
                             {.levels = {{1}}});
    const Pose pose{kLawMiddle + Vector3d(0.01e-3, -0.8e-3, 0.5e-3), expRotation({0.02, 0.3, 0.1})};
    LawRun run(ContactLaw::kPenaltySdf, scene, pose);
    bool has_room = false;
    const ContactWrench at = penaltyOf(run).contactAt(pose, has_room);
    EXPECT_TRUE(has_room);
    EXPECT_GT(at.contacts, 30u);
    constexpr double kStep = 1e-7, kTurn = 1e-4;  // m, rad
    for (int n = 0; n < 6; ++n) {
        Vector6d way = Vector6d::Zero();
        way[n] = n < 3 ? kStep : kTurn;
        const auto moved = [&](double share) {
            bool room;
            const Wrench w =
                penaltyOf(run)
                    .contactAt(pose.incremented(share * way.head<3>(), share * way.tail<3>()), room)
                    .wrench;
            Vector6d v;
            v << w.force, w.torque;
            return v;
        };
        const Vector6d slope = (moved(1) - moved(-1)) / (2 * way[n]);
        const double slack_force = 2e-3 * at.derivative.topLeftCorner<3, 3>().norm() * (n < 3 ? 1 : 1e-3);
        for (int row = 0; row < 6; ++row)
            EXPECT_NEAR(at.derivative(row, n), slope[row], slack_force * (row < 3 ? 1 : 1e-3)) << row << n;
    }
}

// The force is along the bone's normals, and each point's is linear in its depth.
TEST(PenaltySdf, PushesAlongTheBonesNormal) {
    const Vector3d normal = Vector3d(0.3, -0.2, 1).normalized();
    const ContactScene scene = lawPlane(normal);
    LawRun run(ContactLaw::kPenaltySdf, scene, uprightAt(kLawMiddle + kLawRadius * normal));
    const SpoStep step = run.settle(uprightAt(kLawMiddle + (kLawRadius - 0.5e-3) * normal));
    EXPECT_GT(step.wrench_hand_V.force.norm(), 1);
    EXPECT_LT(step.wrench_hand_V.force.cross(normal).norm(), 0.01 * step.wrench_hand_V.force.norm());
}

// Known weakness: each point has its stiffness, so that the bone is as stiff as it is densely sampled.
TEST(PenaltySdf, IsStiffAsTheBoneIsSampled) {
    double force[2];
    int n = 0;
    for (const double voxel : {0.125e-3, 0.25e-3}) {
        const ContactScene scene(cubeGeometry(int(5e-3 / voxel) + 1, voxel), halfSpace(kLawMiddle, {0, 0, 1}),
                                 {SphereShape{{0, 0, 0}, kLawRadius}}, {.levels = {{1}}});
        const Pose pose = uprightAt(kLawMiddle + Vector3d(0, 0, kLawRadius - 0.1e-3));
        LawRun run(ContactLaw::kPenaltySdf, scene, pose);
        bool has_room;
        force[n++] = penaltyOf(run).contactAt(pose, has_room).wrench.force.z();
    }
    EXPECT_NEAR(force[0] / force[1], 4, 0.8);
}

}  // namespace
}  // namespace bonemill

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/unit/haptic_server/laws/law_scene.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr ContactLaw kProxy = ContactLaw::kProxy3Dof;

// No contact point ever comes deeper into the ball than the tolerance, wherever the hand goes: random strokes
// of up to 300 mm/s into a plane that lies askew.
TEST(Proxy3Dof, NeverEntersTheWall) {
    const Vector3d normal = Vector3d(0.3, -0.2, 1).normalized();
    const ContactScene scene = lawPlane(normal);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1.2e-3, 1.2e-3);
    const Vector3d start = kLawMiddle + (kLawRadius + 0.2e-3) * normal;
    LawRun run(kProxy, scene, uprightAt(start));
    Vector3d hand = start, target = start;
    double deepest = 0, lowest = 1;
    for (int n = 0; n < 3000; ++n) {
        if (n % 40 == 0) target = start + Vector3d(place(random), place(random), 2 * place(random));
        hand += 0.1 * (target - hand);
        const SpoStep step = run.to(uprightAt(hand));
        deepest = std::max(deepest, step.max_penetration);
        lowest = std::min(lowest, normal.dot(run.spo.position - kLawMiddle) - kLawRadius);
        EXPECT_TRUE(run.spo.isFinite());
    }
    EXPECT_LE(deepest, BlockedMotion::kTolerance);
    EXPECT_GT(lowest, -1.5 * BlockedMotion::kTolerance);
}

// Zilles and Salisbury: the force is that of a spring from the hand to the proxy, along the surface's normal
// where there is no friction, and the proxy is the surface's nearest place to the hand.
TEST(Proxy3Dof, IsHeldByASpringAtTheNearestPlaceOfTheSurface) {
    const ContactScene scene = lawPlane();
    LawRun run(kProxy, scene, uprightAt(kLawMiddle + Vector3d(0, 0, kLawRadius)));
    const double k = LawConfig{}.coupling.translation_stiffness;
    for (const double depth : {0.1e-3, 0.5e-3, 1e-3}) {
        const SpoStep step = run.settle(uprightAt(kLawMiddle + Vector3d(0.2e-3, 0.1e-3, kLawRadius - depth)));
        const double force = 50 * std::tanh(k * depth / 50);
        EXPECT_NEAR(step.wrench_hand_V.force.z(), force, 0.005 * force);
        EXPECT_LT(step.wrench_hand_V.force.head<2>().norm(), 0.002 * force);
        EXPECT_TRUE(step.wrench_hand_V.torque.isZero(0));
    }
}

TEST(Proxy3Dof, HasNoDragInFreeAir) {
    const ContactScene scene = lawPlane();
    LawRun run(kProxy, scene, uprightAt(kLawMiddle + Vector3d(0, 0, 2e-3)));
    for (int n = 0; n < 20; ++n) {
        const SpoStep step = run.to(uprightAt(kLawMiddle + Vector3d(0.1e-3 * n, 0, 2e-3)));
        EXPECT_LT(step.wrench_hand_V.force.norm(), 1e-9);
    }
}

// What it is known to lack: a shaft that leans on the bone is not felt, and turning costs nothing.
TEST(Proxy3Dof, DoesNotFeelTheShaft) {
    const std::vector<ToolShape> shapes{SphereShape{{0, 0, 0}, kLawRadius},
                                        CapsuleShape{{0, 0, 0}, {0, 0, 6e-3}, kLawRadius / 2}};
    const auto edge = [](const Vector3d& p) { return p.x() - 3.2e-3; };  // a wall beside the shaft
    const ContactScene scene(cubeGeometry(41, kLawVoxel), edge, shapes, {.levels = {{1}}});
    const Pose beside = uprightAt({4.6e-3, 2.5e-3, 0.5e-3});
    const Pose leaning{beside.position, expRotation({0, -60 * kDegree, 0})};  // the shaft is in the wall
    for (const ContactLaw law : {kProxy}) {
        LawRun run(law, scene, beside);
        const SpoStep step = run.settle(leaning);
        EXPECT_LT(step.wrench_hand_V.force.norm(), 1e-6) << lawName(law);
        EXPECT_NEAR(logRotation(run.spo.rotation).norm(), 60 * kDegree, 1e-9);
    }
}

// Bone that is put back around the ball lets it out slowly instead of throwing it.
TEST(Proxy3Dof, IsLetOutOfBoneThatIsThereAtOnce) {
    const ContactScene scene = lawPlane();
    const Pose inside = uprightAt(kLawMiddle + Vector3d(0, 0, kLawRadius - 0.2e-3));
    LawRun run(kProxy, scene, inside);
    double z = inside.position.z();
    for (int n = 0; n < 40; ++n) {
        run.to(inside);
        EXPECT_LE(run.spo.position.z() - z, 1.5 * BlockedMotion::kRecovery * 1e-3);
        z = run.spo.position.z();
    }
    EXPECT_NEAR(z, kLawMiddle.z() + kLawRadius, 6e-6);
}

}  // namespace
}  // namespace bonemill

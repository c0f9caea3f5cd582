#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/unit/haptic_server/laws/law_scene.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr ContactLaw kConstraint = ContactLaw::kConstraint;

// A burr with a shaft, whose axis is x.
const std::vector<ToolShape> kBurrWithShaft{SphereShape{{0, 0, 0}, 0.8e-3},
                                            CapsuleShape{{0, 0, 0}, {2.2e-3, 0, 0}, 0.4e-3}};

TEST(Constraint, NeverPenetratesBeyondItsTolerance) {
    const Vector3d normal = Vector3d(0.3, -0.2, 1).normalized();
    const ContactScene scene(cubeGeometry(41, kLawVoxel), halfSpace(kLawMiddle, normal), kBurrWithShaft,
                             {.levels = {{1}}});
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-1, 1);
    const Pose start = uprightAt(kLawMiddle - Vector3d(1e-3, 0, 0) + 1.2e-3 * normal);
    LawRun run(kConstraint, scene, start, 0.8e-3);
    Pose hand = start, target = start;
    double deepest = 0;
    int touching = 0;
    for (int n = 0; n < 3000; ++n) {
        if (n % 40 == 0)
            target = start.incremented(1e-3 * Vector3d(place(random), place(random), 2 * place(random)),
                                       0.6 * Vector3d(place(random), place(random), place(random)));
        hand.position += 0.1 * (target.position - hand.position);
        hand.rotation = hand.rotation.slerp(0.05, target.rotation);
        const SpoStep step = run.to(hand);
        deepest = std::max(deepest, step.max_penetration);
        touching += step.contacts > 0;
        EXPECT_TRUE(run.spo.isFinite());
        EXPECT_FALSE(step.has_contact_overflow);
    }
    EXPECT_LE(deepest, 2 * BlockedMotion::kTolerance);
    EXPECT_GT(touching, 800);
}

// A slide along the face without friction: no force along it, at rest and while the hand moves.
TEST(Constraint, AFrictionlessSlideHasNoTangentialForce) {
    const Vector3d normal = Vector3d(0.3, -0.2, 1).normalized(),
                   along = normal.cross(Vector3d::UnitY()).normalized();
    const ContactScene scene = lawPlane(normal);
    const auto hand = [&](double way) {
        return uprightAt(kLawMiddle + way * along + (kLawRadius - 0.3e-3) * normal);
    };
    LawRun run(kConstraint, scene, uprightAt(kLawMiddle - 0.8e-3 * along + kLawRadius * normal));
    run.settle(hand(-0.8e-3), 10);
    double false_force = 0, least = INFINITY;
    for (int n = 0; n < 800; ++n) {
        const Vector3d force = run.to(hand(-0.8e-3 + 2e-6 * n)).wrench_hand_V.force;
        false_force = std::max(false_force, (force - force.dot(normal) * normal).norm());
        least = std::min(least, force.dot(normal));
    }
    EXPECT_GT(least, 0.88);  // 0.9 N
    EXPECT_LT(false_force, 0.01 * least);
}

// Gauss: the reaction of the contacts balances the coupling at the constrained pose, and leaves the free
// directions alone.
TEST(Constraint, TheReactionBalancesTheCoupling) {
    const ContactScene scene(cubeGeometry(41, kLawVoxel), halfSpace(kLawMiddle, {0, 0, 1}), kBurrWithShaft,
                             {.levels = {{1}}});
    const Pose start = uprightAt(kLawMiddle + Vector3d(-1e-3, 0, 1e-3));
    LawRun run(kConstraint, scene, start, 0.8e-3);
    const Pose hand{kLawMiddle + Vector3d(-1e-3, 0, 0.5e-3), expRotation({0, 0.5, 0.2})};  // the shaft down
    const SpoStep step = run.settle(hand, 400);
    const Wrench& reaction = static_cast<ConstraintLaw&>(run.model).reaction();
    EXPECT_GT(reaction.force.z(), 0.5);
    EXPECT_LT(reaction.force.head<2>().norm(), 0.01 * reaction.force.z());
    EXPECT_GT(std::abs(reaction.torque.y()), 0.1e-3);  // the shaft lies on the face
    EXPECT_NEAR(step.wrench_hand_V.force.z(), reaction.force.z(), 0.01 * reaction.force.z());
    EXPECT_NEAR(logRotation(run.spo.rotation).z(), 0.2, 0.02);  // nothing hinders the turn on the face
}

// It is what the gradient law becomes when contact is ever stiffer.
TEST(Constraint, IsTheLimitOfTheGradientLaw) {
    const ContactScene scene = lawPlane();
    const Pose start = uprightAt(kLawMiddle + Vector3d(0, 0, kLawRadius));
    const Pose hand = uprightAt(kLawMiddle + Vector3d(0, 0, kLawRadius - 0.5e-3));
    LawRun run(kConstraint, scene, start);
    const double rigid = run.settle(hand).wrench_hand_V.force.z();
    double before = 1;
    for (const double kappa : {1e12, 1e13, 1e14}) {
        GradientConfig config;
        config.contact = {.stiffness_per_area = kappa, .stiffness_cap = INFINITY};
        GradientModel model(config, scene.world(), run.tool, 1e-3);
        model.setAccuracy(presetSettings(Preset::kExact));
        Pose spo = start;
        SpoStep step;
        for (int n = 0; n < 200; ++n) spo = (step = model.advance(spo, hand)).X_VT;
        const double difference = std::abs(step.wrench_hand_V.force.z() / rigid - 1);
        EXPECT_LT(difference, before);
        before = difference;
    }
    EXPECT_LT(before, 0.01);
}

TEST(Constraint, HasNoDragInFreeAir) {
    const ContactScene scene = lawPlane();
    LawRun run(kConstraint, scene, uprightAt(kLawMiddle + Vector3d(0, 0, 2e-3)));
    for (int n = 0; n < 20; ++n) {
        const SpoStep step =
            run.to({kLawMiddle + Vector3d(0.1e-3 * n, 0, 2e-3), expRotation({0, 0.002 * n, 0})});
        EXPECT_LT(step.wrench_hand_V.force.norm(), 1e-9);
        EXPECT_LT(step.wrench_hand_V.torque.norm(), 1e-9);
    }
}

// The bone under the resting tool goes voxel by voxel: the tool follows, and never falls into what is left.
TEST(Constraint, FollowsTheBoneThatIsMilled) {
    ContactScene scene = lawPlane();
    const Pose hand = uprightAt(kLawMiddle + Vector3d(0, 0, kLawRadius - 0.4e-3));
    LawRun run(kConstraint, scene, uprightAt(kLawMiddle + Vector3d(0, 0, kLawRadius)));
    run.settle(hand, 20);
    const double before = run.spo.position.z();
    for (int lowered = 1; lowered <= 8; ++lowered) {
        const double top = kLawTop - lowered * 0.05e-3;
        const VoxelVolume lower =
            bodyVolume(cubeGeometry(41, kLawVoxel), halfSpace({0, 0, top}, Vector3d::UnitZ()));
        const IndexBox all{Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(40)};
        forEachIndex(all, [&](const Eigen::Vector3i& v) {
            scene.bone.volume.set(v.x(), v.y(), v.z(), lower.at(v.x(), v.y(), v.z()));
        });
        scene.bone.lattice.refreshRanges(scene.bone.volume, all);
        scene.bone.shell.refresh(scene.bone.volume, scene.bone.lattice, {&all, 1});
        run.settle(hand, 10);
        EXPECT_NEAR(run.spo.position.z(), std::max(top + kLawRadius, hand.position.z()), 6e-6);
    }
    EXPECT_LT(run.spo.position.z(), before - 0.3e-3);
}

}  // namespace
}  // namespace bonemill

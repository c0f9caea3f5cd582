#include "haptic_server/core/contact/gradient_contact.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/contact_scene.h"
#include "tests/support/eigenvalues.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::vector<ToolShape> kBurrAndShaft = {SphereShape{{0, 0, 0}, 1e-3},
                                              CapsuleShape{{0, 0, 0}, {0, 8e-3, 0}, 0.8e-3}};

// Makes a bumpy block with every direction of normal, edges and pits.
DistanceFunction bumpyBody() {
    return [](const Vector3d& p) {
        const Vector3d q = 1e3 * p;
        return 1e-3 * (q.z() - 4 - 0.6 * std::sin(1.9 * q.x()) * std::sin(1.6 * q.y() + 0.4 * q.z()));
    };
}

Vector6d minusGradient(const GradientContact& contact, const ToolField& tool, const Pose& at) {
    constexpr double kStep = 1e-10;  // m: short, so that hardly a point crosses a seam of the tool
    Vector6d w;
    for (int i = 0; i < 6; ++i) {
        const double h = i < 3 ? kStep : kStep / 2e-3;
        Vector6d step = Vector6d::Zero();
        step[i] = h;
        const auto energy = [&](double sign) {
            return contact
                .evaluate<double>(tool, at.incremented(sign * step.head<3>(), sign * step.tail<3>()))
                .term.energy;
        };
        w[i] = -(energy(1) - energy(-1)) / (2 * h);
    }
    return w;
}

TEST(GradientContact, WrenchIsTheEnergysGradient) {
    const ContactScene scene(cubeGeometry(33, 0.25e-3), bumpyBody(), kBurrAndShaft);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const ToolDistance distance : {ToolDistance::kAnalytic, ToolDistance::kGrid}) {
        const AccuracySettings settings{.tool_distance = distance};
        const ToolField& tool = scene.tool.field(settings);
        int in_contact = 0;
        for (int n = 0; n < 60; ++n) {
            const Pose X_VT{Vector3d(4e-3, 4e-3, 4.6e-3) +
                                0.7e-3 * Vector3d(uniform(random), uniform(random), uniform(random)),
                            randomRotation(random)};
            GradientContact contact({.stiffness_per_area = 1e11, .stiffness_cap = kInfinity});
            contact.gather(scene.view(), tool, X_VT, 0.1e-3);
            const GradientContactResult result = contact.evaluate<double>(tool, X_VT);
            if (result.contacts < 5) continue;
            ++in_contact;
            Vector6d w;
            w << result.term.wrench.force, result.term.wrench.torque;
            const Vector6d expected = minusGradient(contact, tool, X_VT);
            EXPECT_LT((w - expected).head<3>().norm(), 1e-6 * (1 + expected.head<3>().norm()));
            EXPECT_LT((w - expected).tail<3>().norm(), 1e-6 * (2e-3 + expected.tail<3>().norm()));
        }
        EXPECT_GT(in_contact, 30);
    }
}

TEST(GradientContact, StiffnessIsPositiveSemiDefiniteAndForAFlatFaceTheDerivative) {
    const Vector3d on_face(4e-3, 4e-3, 4.05e-3);
    const ContactScene scene(cubeGeometry(33, 0.25e-3), halfSpace(on_face, Vector3d::UnitZ()), kBurrAndShaft);
    const AccuracySettings settings;
    const GradientContactConfig config{.stiffness_per_area = 1e11};
    const Pose X_VT{on_face + Vector3d(0, 0, 0.7e-3), expRotation({M_PI / 2, 0, 0})};  // shaft upright
    GradientContact contact(config);
    const ToolField& tool = scene.tool.field(settings);
    contact.gather(scene.view(), tool, X_VT, 0.1e-3);
    const GradientContactResult here = contact.evaluate<double>(tool, X_VT);
    const Vector6d modes = test::eigenvaluesOf(here.term.stiffness);
    EXPECT_GT(modes[0], -1e-9 * modes[5]);
    // Along the normal the Gauss-Newton matrix leaves out only the sphere's curvature.
    const GradientContactResult higher =
        contact.evaluate<double>(tool, {X_VT.position + Vector3d(0, 0, 1e-7), X_VT.rotation});
    const double slope = (here.term.wrench.force.z() - higher.term.wrench.force.z()) / 1e-7;
    EXPECT_NEAR(here.term.stiffness(2, 2), slope, 0.35 * slope);
    EXPECT_GT(here.term.stiffness(2, 2), slope);
}

TEST(GradientContact, FloatAndDoubleAgree) {
    const ContactScene scene(cubeGeometry(33, 0.25e-3), bumpyBody(), kBurrAndShaft);
    const Pose X_VT{{4e-3, 4e-3, 4.8e-3}, expRotation({1.2, 0.1, 0})};
    const GradientContactConfig config;
    const GradientContactResult in_float = scene.contactAt(config, {.precision = Precision::kFloat}, X_VT);
    const GradientContactResult in_double = scene.contactAt(config, {.precision = Precision::kDouble}, X_VT);
    EXPECT_GT(in_double.contacts, 10u);
    EXPECT_LT((in_float.term.wrench.force - in_double.term.wrench.force).norm(),
              1e-4 * in_double.term.wrench.force.norm());
    EXPECT_NEAR(in_float.term.energy, in_double.term.energy, 2e-4 * in_double.term.energy);
}

TEST(GradientContact, GatheringFindsAllThatAMotionCanTouch) {
    const ContactScene scene(cubeGeometry(33, 0.25e-3), bumpyBody(), kBurrAndShaft);
    const ToolField& tool = scene.tool.field({});
    const GradientContactConfig config;
    const ShellView view = scene.view({.sample_spacing = 0});
    const Pose start{{4e-3, 4e-3, 5.5e-3}, expRotation({1.2, 0.1, 0})};
    GradientContact near(config), all(config);
    near.gather(view, tool, start, 0.5e-3);
    all.gather(view, tool, start, 1);
    EXPECT_LT(near.candidateCount(), all.candidateCount());
    EXPECT_EQ(all.candidateCount(), scene.bone.shell.pointCount(0));
    const Pose moved{start.position - Vector3d(0, 0, 0.499e-3), start.rotation};
    EXPECT_EQ(near.evaluate<double>(tool, moved).contacts, all.evaluate<double>(tool, moved).contacts);
    EXPECT_GT(near.evaluate<double>(tool, moved).contacts, 0u);
}

// Even one whose square is no float ends where the room for samples does.
TEST(GradientContact, NoSpacingIsTooFine) {
    const ContactScene scene(cubeGeometry(33, 0.25e-3), bumpyBody(), kBurrAndShaft);
    const Pose X_VT{{4e-3, 4e-3, 4.8e-3}, expRotation({1.2, 0.1, 0})};
    for (const double spacing : {1e-20, 1e-200}) {
        const double force = scene.contactAt({}, {.sample_spacing = spacing}, X_VT).term.wrench.force.norm();
        EXPECT_TRUE(force > 0 && std::isfinite(force)) << spacing;
    }
}

// Whatever is skipped leaf by leaf and block by block, there are as many candidates as a test of
// every point finds.
TEST(GradientContact, CandidatesAreThePointsNearTheTool) {
    const ContactScene scene(cubeGeometry(65, 0.125e-3), bumpyBody(), kBurrAndShaft);
    std::mt19937 random(21);
    std::uniform_real_distribution<double> uniform(-1, 1);
    constexpr double kSlack = 1e-8;  // m, of single precision
    size_t most = 0;
    for (int n = 0; n < 200; ++n) {
        const AccuracySettings settings{.sample_spacing = n % 2 * 60e-6, .most_samples = 0};
        const ToolField& tool = scene.tool.field(settings);
        const Pose X_VT{Vector3d(4e-3, 4e-3, 4.8e-3) +
                            1.5e-3 * Vector3d(uniform(random), uniform(random), uniform(random)),
                        randomRotation(random)};
        const double margin = n % 3 * 0.2e-3;
        const Pose X_TV = X_VT.inverse();
        size_t surely = 0, perhaps = 0;
        for (LeafId leaf = 0; leaf < scene.bone.lattice.leafCount(); ++leaf)
            scene.bone.shell.forEachBlock(0, leaf, [&](const ShellBlock& b, uint32_t count) {
                for (uint32_t i = 0; i < count; ++i) {
                    // A patch reaches over its point by little more than half a cell's diagonal.
                    const double patch =
                        settings.sample_spacing > 0 ? 0.6 * scene.bone.volume.spacing().norm() : 0;
                    const double gap = tool.sample(X_TV * Vector3d(b.x[i], b.y[i], b.z[i])).distance - margin;
                    surely += gap < -kSlack;
                    perhaps += gap < patch + kSlack;
                }
            });
        GradientContact contact({.stiffness_per_area = 1e11});
        contact.gather(scene.view(settings), tool, X_VT, margin);
        ASSERT_GE(contact.candidateCount(), surely);
        ASSERT_LE(contact.candidateCount(), perhaps);
        most = std::max(most, contact.candidateCount());
    }
    EXPECT_GT(most, 300u);
}

TEST(GradientContact, SaysWhenThereIsNoRoom) {
    const ContactScene scene(cubeGeometry(33, 0.25e-3), bumpyBody(), kBurrAndShaft);
    GradientContact contact({}, 50);
    EXPECT_FALSE(contact.gather(scene.view(), scene.tool.field({}), Pose{{4e-3, 4e-3, 5e-3}}, 1e-3));
    EXPECT_LE(contact.candidateCount(), 50u);
}

// With less time there are fewer samples, which is said; the force hardly changes. With time they come back.
TEST(GradientContact, SamplesLessFinelyWhenThereIsNoTime) {
    const ContactScene scene(cubeGeometry(33, 0.25e-3), bumpyBody(), kBurrAndShaft);
    const ToolField& tool = scene.tool.field({});
    const ShellView view = scene.view();
    Pose X_VT{{4e-3, 4e-3, 5e-3}};
    GradientContact contact({});
    constexpr double kMargin = 0.05e-3;
    constexpr size_t kFew = 4300;  // point tests
    const auto force = [&] { return contact.evaluate<double>(tool, X_VT).term.wrench.force; };
    ASSERT_TRUE(contact.gather(view, tool, X_VT, kMargin));
    EXPECT_FALSE(contact.hasFewerSamples());
    const size_t all = contact.candidateCount();
    const Vector3d of_all = force();
    ASSERT_GT(of_all.norm(), 0.1);
    contact.forget();
    ASSERT_TRUE(contact.gather(view, tool, X_VT, kMargin, kFew));
    EXPECT_TRUE(contact.hasFewerSamples());
    EXPECT_LT(contact.candidateCount(), 0.7 * double(all));
    EXPECT_LT((force() - of_all).norm(), 0.1 * of_all.norm());
    contact.forget();
    ASSERT_TRUE(contact.gather(view, tool, X_VT, kMargin));
    EXPECT_FALSE(contact.hasFewerSamples());
    EXPECT_EQ(contact.candidateCount(), all);
    // Also those that were near all the while.
    for (int n = 0; n < 50; ++n) ASSERT_TRUE(contact.gather(view, tool, X_VT, kMargin, kFew));
    EXPECT_TRUE(contact.hasFewerSamples());
    ASSERT_TRUE(contact.gather(view, tool, X_VT, kMargin));
    EXPECT_FALSE(contact.hasFewerSamples());
    EXPECT_EQ(contact.candidateCount(), all);
}

// Patches keep the fineness that they had when they came near, and have more and more pieces in reach as the
// tool sinks in. There are soon no more than asked for, and the force hardly shows how they become fewer.
TEST(GradientContact, ManyKnownPatchesAreCutLessFinelyAFewAtATime) {
    const ContactScene scene(
        cubeGeometry(33, 0.25e-3), [](const Vector3d& p) { return p.z() - 4e-3; }, kBurrAndShaft);
    const AccuracySettings settings{.most_samples = 200};
    const ToolField& tool = scene.tool.field(settings);
    GradientContact contact({});
    constexpr double kMargin = 20e-6;
    Pose X_VT{{4e-3, 4e-3, 4.995e-3}};
    ASSERT_TRUE(contact.gather(scene.view(settings), tool, X_VT, kMargin));
    X_VT.position.z() -= 60e-6;
    ASSERT_TRUE(contact.gather(scene.view(settings), tool, X_VT, kMargin));
    const size_t at_first = contact.candidateCount();
    EXPECT_GT(at_first, 250u);
    // Not in a gathering for once.
    ShellView for_once = scene.view(settings);
    for_once.may_coarsen = false;
    for (int n = 0; n < 10; ++n) ASSERT_TRUE(contact.gather(for_once, tool, X_VT, kMargin));
    EXPECT_EQ(contact.candidateCount(), at_first);
    const auto force = [&] { return contact.evaluate<double>(tool, X_VT).term.wrench.force.z(); };
    double before = force();
    ASSERT_GT(before, 0.5);
    for (int n = 0; n < 100; ++n) {
        ASSERT_TRUE(contact.gather(scene.view(settings), tool, X_VT, kMargin));
        EXPECT_FALSE(contact.hasFewerSamples());  // than asked for
        const double now = force();
        EXPECT_NEAR(now / before, 1, 5e-3);
        before = now;
    }
    EXPECT_LE(contact.candidateCount(), 220u);
    EXPECT_GT(contact.candidateCount(), 100u);
}

// The wall is thinner than the burr, and its far side lies inside the burr: the far side must not pull.
TEST(GradientContact, TheFarSideOfAThinWallDoesNotPull) {
    const double top = 4.3e-3, thickness = 0.3e-3;
    const ContactScene scene(
        cubeGeometry(65, 0.125e-3),
        [=](const Vector3d& p) { return std::abs(p.z() - top + thickness / 2) - thickness / 2; },
        kBurrAndShaft);
    for (const double depth : {0.1e-3, 0.4e-3, 0.6e-3, 0.9e-3, 1.1e-3, 1.25e-3}) {
        const Pose X_VT{{4e-3, 4e-3, top + 1e-3 - depth}, expRotation({M_PI / 2, 0, 0})};
        const GradientContactResult result = scene.contactAt({.stiffness_per_area = 1e10}, {}, X_VT);
        EXPECT_GE(result.term.wrench.force.z(), -1e-6) << depth;
        if (depth < 0.7e-3) {
            EXPECT_GT(result.term.wrench.force.z(), 0.01) << depth;
        }
    }
}

// One direction's stiffness is the cap's, whether one face, two or all around are touched.
TEST(GradientContact, StiffnessCapIsTheSameForPlaneSlotAndSurround) {
    const double kCap = 5e3, kKappa = 1e12;
    const Vector3d center(4e-3, 4e-3, 4e-3);
    const std::vector<ToolShape> ball = {SphereShape{{0, 0, 0}, 2e-3}};
    const auto slot = [&](const Vector3d& p) { return 1.9e-3 - std::abs(p.z() - center.z()); };
    const auto surround = [&](const Vector3d& p) { return 1.9e-3 - (p - center).norm(); };
    const ContactScene plane_scene(cubeGeometry(33, 0.25e-3), halfSpace({0, 0, 2.1e-3}, Vector3d::UnitZ()),
                                   ball);
    const ContactScene slot_scene(cubeGeometry(33, 0.25e-3), slot, ball);
    const ContactScene surround_scene(cubeGeometry(33, 0.25e-3), surround, ball);
    const AccuracySettings settings;
    for (const ContactScene* scene : {&plane_scene, &slot_scene, &surround_scene}) {
        const auto uncapped = scene->contactAt({kKappa, kInfinity}, settings, Pose{center});
        const auto capped = scene->contactAt({kKappa, kCap}, settings, Pose{center});
        EXPECT_GT(uncapped.term.stiffness(2, 2), 10 * kCap);
        EXPECT_NEAR(capped.term.stiffness(2, 2), kCap, 0.2 * kCap);  // shallow points count in part
    }
}

// The tests from here on are of advance().

TEST(Advance, StopsBeforeAWallAtAnySpeed) {
    const double top = 4.3e-3, thickness = 0.125e-3;
    const ContactScene scene(
        cubeGeometry(65, 0.125e-3),
        [=](const Vector3d& p) { return std::abs(p.z() - top + thickness / 2) - thickness / 2; },
        kBurrAndShaft);
    const ToolField& tool = scene.tool.field({});
    const Pose start{{4e-3, 4e-3, 7e-3}, expRotation({M_PI / 2, 0, 0})};
    for (const double length : {0.5e-3, 3e-3, 20e-3, 100e-3}) {
        GradientContact contact({});
        contact.gather(scene.view(), tool, start, length);
        Vector6d step = Vector6d::Zero();
        step.z() = -length;
        const double moved = length * contact.advance(tool, start, step, 0.1e-3);
        const double gap = 7e-3 - 1e-3 - top;
        if (length < gap)
            EXPECT_DOUBLE_EQ(moved, length);
        else {
            EXPECT_LE(moved, gap + 0.1e-3 + 10e-6);
            EXPECT_GE(moved, gap);
        }
    }
}

TEST(Advance, SweepsRotationsToo) {
    const ContactScene scene(cubeGeometry(65, 0.125e-3), sphereAt({4e-3, 4e-3, 2e-3}, 0.8e-3), kBurrAndShaft);
    const ToolField& tool = scene.tool.field({});
    // The shaft sweeps over the ball while the tool point rests beside it.
    const Pose start{{4e-3, 0.5e-3, 2e-3}, expRotation({0, 0, -0.9})};
    Vector6d step = Vector6d::Zero();
    step[5] = 1.8;
    GradientContact contact({});
    contact.gather(scene.view(), tool, start, 30e-3);
    const double share = contact.advance(tool, start, step, 0.05e-3);
    EXPECT_GT(share, 0.05);
    EXPECT_LT(share, 0.5);
    const Pose stopped = start.incremented(share * step.head<3>(), share * step.tail<3>());
    EXPECT_LE(contact.evaluate<double>(tool, stopped).max_depth, 0.05e-3);
    EXPECT_GT(contact.evaluate<double>(tool, stopped).max_depth, 0.02e-3);
}

}  // namespace
}  // namespace bonemill

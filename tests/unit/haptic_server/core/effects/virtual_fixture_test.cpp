#include <gtest/gtest.h>

#include <random>

#include "haptic_server/core/effects/effect_host.h"
#include "tests/support/contact_scene.h"
#include "tests/support/eigenvalues.h"
#include "tests/support/typical_effects.h"
#include "tests/unit/haptic_server/core/effects/tissue_bench.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

const Vector3d kNervePlace(4e-3, 4e-3, 3e-3);
constexpr double kNerveRadius = 0.7e-3;

const TissueBench& bench() {
    static const TissueBench kBench(sphereAt(kNervePlace, kNerveRadius));
    return kBench;
}

Burr burrOf(BurrKind kind) {
    Burr burr{.kind = kind, .radius = kBurr};
    if (kind != BurrKind::kBall) burr.length = 3e-3;
    if (kind == BurrKind::kCone) burr.tip_radius = 0.4e-3;
    return burr;
}

VirtualFixtureConfig typicalBut(double VirtualFixtureConfig::*field, double value) {
    VirtualFixtureConfig config = test::kVirtualFixture;
    config.*field = value;
    return config;
}

// The fixture with its tool is asked as the tick asks it.
struct Fixture {
    explicit Fixture(const VirtualFixtureConfig& config, const Burr& burr = burrOf(BurrKind::kBall))
        : fixture(config.make({bench().config.effects, bench().bone, {}})), tool{&bench().tool, burr, 12} {
        tick.tool = &tool;
        fixture->begin(tick);
    }
    EnergyTerm at(const Pose& X_VT) const { return fixture->energy(tick, X_VT); }

    std::unique_ptr<HapticEffect> fixture;
    SpoTool tool;
    EffectTick tick;
};

Pose randomPose(std::mt19937& random) {
    std::uniform_real_distribution<double> place(-1.9e-3, 1.9e-3);
    return {kNervePlace + Vector3d(place(random), place(random), place(random)), randomRotation(random)};
}

TEST(VirtualFixture, PushesBackByDepthInTheRegion) {
    const VirtualFixtureConfig config{
        .distance = 1e-3, .stiffness = 2000, .max_force = 10, .hand_force_scale = 1};
    const Fixture fixture(config);
    EXPECT_EQ(fixture.at({kNervePlace + Vector3d(0, 0, kNerveRadius + kBurr + 1.2e-3), {}}).energy, 0);
    const EnergyTerm term = fixture.at(
        {kNervePlace + Vector3d(0, 0, kNerveRadius + kBurr + 0.5e-3), Eigen::Quaterniond::Identity()});
    EXPECT_NEAR(term.wrench.force.z(), 2000 * 0.5e-3, 0.15);  // a ball of voxels
    EXPECT_LT(term.wrench.force.head<2>().norm(), 0.1);
    const EnergyTerm deep = fixture.at({kNervePlace, Eigen::Quaterniond::Identity()});
    EXPECT_LE(deep.wrench.force.norm(), 10 * 1.8);  // the field of voxels is steeper than 1 in places
}

// Round a ball there are no jumps from voxel to voxel, and the force is the same everywhere but for the
// stairs of the labels.
TEST(VirtualFixture, ForceHasNoJumpsRoundABall) {
    const VirtualFixtureConfig config{
        .distance = 1e-3, .stiffness = 2000, .max_force = 10, .hand_force_scale = 1};
    const Fixture fixture(config);
    constexpr int kSteps = 20'000;
    const double radius = kNerveRadius + kBurr + 0.5e-3, step = 2 * M_PI * radius / kSteps;
    Vector3d before = Vector3d::Zero();
    for (int n = 0; n <= kSteps; ++n) {
        const double angle = 2 * M_PI * n / kSteps;
        const Vector3d place =
            kNervePlace + radius * Vector3d(std::cos(angle), 0.6 * std::sin(angle), 0.8 * std::sin(angle));
        const Vector3d force = fixture.at({place, Eigen::Quaterniond::Identity()}).wrench.force;
        EXPECT_NEAR(force.norm(), 1, 0.15);
        // The force changes by 2 kN/m along, by F/r and the bends of the field across.
        if (n > 0) {
            EXPECT_LT((force - before).norm(), 3 * config.stiffness * step) << n;
        }
        before = force;
    }
}

TEST(VirtualFixture, WrenchIsMinusTheGradientOfTheEnergy) {
    std::mt19937 random(7);
    for (const BurrKind kind : {BurrKind::kBall, BurrKind::kCylinder, BurrKind::kCone}) {
        const Fixture fixture(typicalBut(&VirtualFixtureConfig::max_force, 1.5), burrOf(kind));
        int felt = 0;
        for (int n = 0; n < 400; ++n) {
            const Pose pose = randomPose(random);
            const EnergyTerm term = fixture.at(pose);
            constexpr double kStep = 1e-9;
            Vector6d slope, kink;
            for (int axis = 0; axis < 6; ++axis) {
                Vector6d step = Vector6d::Zero();
                step[axis] = axis < 3 ? kStep : kStep * 1e3;
                const auto energy = [&](double sign) {
                    return fixture.at(pose.incremented(sign * step.head<3>(), sign * step.tail<3>())).energy;
                };
                slope[axis] = (energy(1) - energy(-1)) / (2 * step[axis]);
                kink[axis] = (energy(1) + energy(-1) - 2 * term.energy) / step[axis];
            }
            if (term.energy == 0) continue;
            // Between two of the field's cells the slope jumps.
            if (kink.head<3>().norm() > 1e-3 || kink.tail<3>().norm() > 1e-6) continue;
            ++felt;
            EXPECT_LT((slope.head<3>() + term.wrench.force).norm(), 2e-3);
            EXPECT_LT((slope.tail<3>() + term.wrench.torque).norm(), 5e-6);
        }
        EXPECT_GT(felt, 80);
    }
}

TEST(VirtualFixture, StiffnessIsPositiveSemiDefiniteAndBounded) {
    std::mt19937 random(8);
    const Fixture fixture(typicalBut(&VirtualFixtureConfig::stiffness, 3000), burrOf(BurrKind::kCylinder));
    for (int n = 0; n < 300; ++n) {
        const EnergyTerm term = fixture.at(randomPose(random));
        const Vector6d values = test::eigenvaluesOf(term.stiffness);
        EXPECT_GE(values.minCoeff(), -1e-9 * values.maxCoeff());
        EXPECT_LE((term.stiffness.topLeftCorner<3, 3>().norm()), 3 * 3000);
        EXPECT_GE(term.energy, 0);
    }
}

// The smooth minimum of a burr with edges is never more than a few hundredths of its radius too careful.
TEST(VirtualFixture, EdgesReachAsFarAsTheBall) {
    const Burr burr = burrOf(BurrKind::kCylinder);
    const VirtualFixtureConfig config{
        .distance = 1e-3, .stiffness = 2000, .max_force = 100, .hand_force_scale = 1};
    const Fixture fixture(config, burr);
    // The burr's flat end is above the nerve.
    const double height = kNerveRadius + burr.length / 2 + 0.6e-3;
    const Pose pose{kNervePlace + Vector3d(0, 0, height), expRotation({M_PI / 2, 0, 0})};
    const double expected = 2000 * 0.4e-3;
    EXPECT_NEAR(fixture.at(pose).wrench.force.norm(), expected, 2000 * 0.2 * burr.radius);
}

double handForce(Fixture& fixture, bool is_near, double force) {
    fixture.tick.X_VT_start.position =
        kNervePlace + Vector3d(0, 0, kNerveRadius + kBurr + (is_near ? 0.2e-3 : 2e-3));
    fixture.fixture->begin(fixture.tick);
    Wrench wrench{{0, 0, force}, Vector3d::Zero()};
    fixture.fixture->addToHand(fixture.tick, wrench);
    return wrench.force.z();
}

TEST(VirtualFixture, HandForceScaleFallsNearbyAndRisesOnlyWhenTheHandIsFree) {
    Fixture fixture(typicalBut(&VirtualFixtureConfig::hand_force_scale, 0.4));
    EXPECT_EQ(handForce(fixture, false, 2), 2);
    double last = 2;
    for (int n = 0; n < 30; ++n) {
        const double now = handForce(fixture, true, 2);
        EXPECT_LE(now, last);
        EXPECT_GT(now, last - 0.11);  // no jump
        last = now;
    }
    EXPECT_NEAR(last, 0.8, 1e-9);
    for (int n = 0; n < 30; ++n) EXPECT_NEAR(handForce(fixture, false, 2), 0.8, 1e-9);
    for (int n = 0; n < 30; ++n) handForce(fixture, false, 0.01);
    EXPECT_EQ(handForce(fixture, false, 2), 2);
}

// The burr goes round and round through the region: the solve gives its pose, and the hand has a path
// of its own.
TEST(VirtualFixture, ClosedPathsOfTheHandGainNoEnergy) {
    const TissueBench& scene = bench();
    for (const double scale : {1.0, 0.5}) {
        const VirtualFixtureConfig fixture_config{
            .distance = 1e-3, .stiffness = 2500, .max_force = 10, .hand_force_scale = scale};
        EffectList effects;
        effects.push_back(fixture_config.make({scene.config.effects, scene.bone, {}}));
        EffectHost host(std::move(effects), 1, 1e12);
        GradientConfig config;
        config.coupling.damping_time = 0;
        config.coupling.relaxing_share = 0;
        const SpoTool tool{&scene.tool, burrOf(BurrKind::kBall), 50};
        GradientModel model(config, {scene.bone.volume, scene.bone.lattice, scene.bone.shell}, tool, 1e-3);
        AccuracySettings settings = presetSettings(Preset::kBalanced);
        settings.iterations = AccuracySettings::kMaxIterations;
        model.setAccuracy(settings);
        model.setEffects(host.weights(), host.energy());
        constexpr int kTicks = 8000;
        const auto device = [&](int n) {
            const double turn = 2 * M_PI * n / kTicks;
            // The path starts above the bone and goes down to the nerve's region from the side, twice around.
            const Vector3d p(1.6e-3 * std::sin(2 * turn), 0.9e-3 * std::sin(3 * turn),
                             kTop - kNervePlace.z() + kBurr + 0.9e-3 * std::cos(turn) - 0.8e-3);
            return Pose{kNervePlace + p, expRotation({0.3 * std::sin(turn), 0, 0})};
        };
        Pose spo = device(0), before = spo;
        Wrench last;
        double put_in = 0, most = 0;
        for (int n = 0; n <= 3 * kTicks; ++n) {
            const Pose hand = device(n);
            EffectTick start;
            start.dt = 1e-3;
            start.tool = &tool;
            start.X_VT_start = spo;
            host.begin(start);
            const SpoStep step = model.advance(spo, hand);
            spo = step.X_VT;
            Wrench felt = step.wrench_hand_V;
            host.addToHand(felt);
            const Vector3d moved = hand.position - before.position;
            const Vector3d turned = logRotation(hand.rotation * before.rotation.conjugate());
            put_in -= 0.5 * ((last.force + felt.force).dot(moved) + (last.torque + felt.torque).dot(turned));
            most = std::max(most, put_in);
            before = hand, last = felt;
        }
        EXPECT_GT(most, 50e-6) << "the region was not felt";
        EXPECT_GT(put_in, -0.02 * most) << scale;
    }
}

// The tool is pressed into the region in the air, at the loop's rate: it comes to rest where coupling and
// fixture agree.
TEST(VirtualFixture, HoldsThePressedToolStill) {
    TissueBench air(sphereAt({4e-3, 4e-3, 6.5e-3}, kNerveRadius));
    air.config.effects.virtual_fixture = {
        .distance = 0.5e-3, .stiffness = 4000, .max_force = 10, .hand_force_scale = 1};
    FixedTick tick = air.makeTick();
    const Vector3d start(5e-3, 4.3e-3, 9e-3), end(4.3e-3, 4.1e-3, 8.2e-3);
    auto inputs = straightPath(TissueBench::at(start), end, 300, 0);
    inputs.insert(inputs.end(), 700, inputs.back());
    const auto records = air.run(tick, inputs);
    const auto force = [](const TickRecord& r) {
        return Vector3d(r.f_hand_W[0], r.f_hand_W[1], r.f_hand_W[2]);
    };
    const Vector3d last = force(records.back());
    EXPECT_GT(last.norm(), 0.2);
    EXPECT_GT(last.normalized().dot((end - Vector3d(4e-3, 4e-3, 6.5e-3)).normalized()), 0.8);
    for (size_t n = 800; n < records.size(); ++n)
        EXPECT_LT((force(records[n]) - last).norm(), 0.01 * last.norm());
}

}  // namespace
}  // namespace bonemill

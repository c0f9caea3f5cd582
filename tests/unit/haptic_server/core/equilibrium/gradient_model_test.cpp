#include "haptic_server/core/equilibrium/gradient_model.h"

#include <gtest/gtest.h>

#include "tests/support/contact_scene.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kVoxel = 0.3e-3, kTop = 5.05e-3, kRadius = 1.5e-3;
const Vector3d kAbove(4.83e-3, 4.71e-3, kTop + kRadius);
const Eigen::Quaterniond kUpright = expRotation({M_PI / 2, 0, 0});

ContactScene flatScene(const Vector3d& normal = Vector3d::UnitZ()) {
    return {cubeGeometry(33, kVoxel),
            halfSpace({4.8e-3, 4.8e-3, kTop}, normal),
            {SphereShape{{0, 0, 0}, kRadius}},
            {.levels = {{1}, {2}}}};
}

constexpr double kMaxForce = 12;  // N, of the coupling

SpoTool toolOf(const ContactScene& scene, double radius = kRadius) {
    return {&scene.tool, {.radius = radius}, kMaxForce};
}

// Runs until the tool rests.
SpoStep settle(GradientModel& model, Pose spo, const Pose& device, int ticks = 60) {
    SpoStep step;
    for (int n = 0; n < ticks; ++n) {
        step = model.advance(spo, device);
        spo = step.X_VT;
    }
    return step;
}

TEST(AccuracySettings, DefaultsAreBalanced) {
    EXPECT_EQ(AccuracySettings{}, presetSettings(Preset::kBalanced));
}

TEST(GradientModel, SettlesWhereCouplingAndContactBalance) {
    const ContactScene scene = flatScene();
    const GradientConfig config{};
    const double kappa = config.contact.stiffness_per_area, k = config.coupling.translation_stiffness;
    const double most = kMaxForce;
    for (const Preset preset : {Preset::kBalanced, Preset::kExact})
        for (const double depth : {0.2e-3, 1e-3, 3e-3}) {
            GradientModel model(config, scene.world(), toolOf(scene), 1e-3);
            model.setAccuracy(presetSettings(preset));
            const SpoStep step =
                settle(model, {kAbove, kUpright}, {kAbove - depth * Vector3d::UnitZ(), kUpright});
            double low = 0, high = std::min(depth, kRadius / 2);  // truth by bisection
            for (int n = 0; n < 100; ++n) {
                const double delta = (low + high) / 2;
                const double contact = M_PI * kappa * (kRadius - delta) * delta * delta;
                (contact < most * std::tanh(k * (depth - delta) / most) ? low : high) = delta;
            }
            const double force = most * std::tanh(k * (depth - low) / most);
            const double bound = preset == Preset::kExact ? 0.01 : 0.03;
            EXPECT_NEAR(step.wrench_hand_V.force.z() / force, 1, bound) << presetName(preset) << " " << depth;
            EXPECT_LT(step.wrench_hand_V.force.head<2>().norm(),
                      std::tan(bound == 0.01 ? 0.0175 : 0.035) * force);
            EXPECT_NEAR(step.X_VT.position.z() - kAbove.z(), -low, 2e-6);
            EXPECT_TRUE(step.is_solved);
        }
}

// The bone is so hard that even the shortest cut of the step goes too deep.
TEST(GradientModel, SaysSoWhenItFindsNoWayToBalance) {
    const ContactScene scene = flatScene();
    for (const bool is_hard : {false, true}) {
        GradientConfig config;
        config.contact.stiffness_cap = INFINITY;
        if (is_hard) config.contact.stiffness_per_area = 1e24;
        GradientModel model(config, scene.world(), toolOf(scene), 1e-3);
        Pose spo{kAbove + Vector3d(0, 0, 1e-9), kUpright};
        int stalled = 0;
        for (int n = 0; n < 40; ++n) {
            const SpoStep step = model.advance(spo, {kAbove - Vector3d(0, 0, 1e-3), kUpright});
            EXPECT_TRUE(step.is_solved);
            stalled += step.has_stalled;
            spo = step.X_VT;
        }
        EXPECT_EQ(stalled, is_hard ? 40 : 0);
    }
}

TEST(GradientModel, FreeToolFollowsAtThePaceOfTheDampingTimeWhateverTheRate) {
    const ContactScene scene = flatScene();
    GradientConfig config;
    config.coupling.relaxing_share = 0;
    const Pose start{kAbove + Vector3d(0, 0, 1e-3), kUpright};
    const Pose device = start.incremented({0.1e-3, 0, 0.05e-3}, {0.001, 0.002, 0});
    double left_of_first = 0;
    for (const double rate : {1000.0, 4000.0}) {
        GradientModel model(config, scene.world(), toolOf(scene), 1 / rate);
        const SpoStep step = settle(model, start, device, int(5e-3 * rate));
        const double left = (step.X_VT.position - device.position).norm() / 0.1118e-3;
        EXPECT_LT(left, 0.05);
        if (left_of_first == 0) left_of_first = left;
        EXPECT_EQ(step.contacts, 0u);
    }
    EXPECT_NEAR(left_of_first, std::pow(0.5, 5), 0.02);  // implicit Euler with dt = τ halves it every tick
}

// In free air, at 5 and 8 rad/s against a limit of 4.19, the tool's turn lags, and nothing else. The hand
// moves before the turn, then also during it.
TEST(GradientModel, AHandThatTurnsTooQuicklyKeepsTheToolsPlace) {
    const ContactScene scene = flatScene();
    for (const double speed : {5.0, 8.0})
        for (const bool moves_on : {false, true})
            for (const Preset preset : {Preset::kFast, Preset::kBalanced, Preset::kExact}) {
                GradientModel model(GradientConfig{}, scene.world(), toolOf(scene), 1e-3);
                model.setAccuracy(presetSettings(preset));
                Pose device{kAbove + Vector3d(0, 0, 5e-3), kUpright}, spo = device;
                double farthest = 0, most = 0;
                for (int n = 0; n < 900; ++n) {
                    const bool moves = n < 100 || moves_on, turns = n >= 100 && n < 100 + 2000 / speed;
                    device = device.incremented({moves ? 50e-6 : 0, 0, 0}, {0, turns ? speed * 1e-3 : 0, 0});
                    const SpoStep step = model.advance(spo, device);
                    spo = step.X_VT;
                    ASSERT_EQ(step.contacts, 0u);
                    farthest = std::max(farthest, (spo.position - device.position).norm());
                    most = std::max(most, step.wrench_hand_V.force.norm());
                }
                EXPECT_LT(farthest, 0.06e-3) << presetName(preset) << ' ' << speed << ' ' << moves_on;
                EXPECT_LT(most, 0.3) << presetName(preset) << ' ' << speed << ' ' << moves_on;
            }
}

TEST(GradientModel, RelaxingSpringStiffensAHeldToolForAShortTimeAndDoesNotHoldBackAFreeOne) {
    const ContactScene scene = flatScene();
    const GradientConfig config{};
    const EnergyCouplingConfig& coupling = config.coupling;
    GradientModel model(config, scene.world(), toolOf(scene), 1e-3);
    // The tool is pressed into the bone, and the hand then goes a sudden small step further.
    const Pose device{kAbove - Vector3d(0, 0, 0.5e-3), kUpright},
        further = device.incremented({0, 0, -0.02e-3}, {0, 0, 0});
    const SpoStep rest = settle(model, {kAbove, kUpright}, device);
    const SpoStep at_once = model.advance(rest.X_VT, further);
    const double first = at_once.wrench_hand_V.force.z() - rest.wrench_hand_V.force.z();
    const double later =
        settle(model, at_once.X_VT, further).wrench_hand_V.force.z() - rest.wrench_hand_V.force.z();
    const double quick = coupling.relaxing_share * coupling.translation_stiffness * coupling.relaxing_time /
                         (coupling.relaxing_time + 1e-3);
    EXPECT_NEAR((first - later) / (quick * 0.02e-3), 1, 0.1);
    // In free motion at constant speed it is as if there were no relaxing spring.
    GradientConfig without = config;
    without.coupling.relaxing_share = 0;
    double drag[2];
    for (int with = 0; with < 2; ++with) {
        GradientModel free_model(with ? config : without, scene.world(), toolOf(scene), 1e-3);
        Pose spo{kAbove + Vector3d(0, 0, 1e-3), kUpright};
        for (int n = 0; n < 100; ++n) {
            const SpoStep step = free_model.advance(spo, spo.incremented({0, 0, 0}, {0, 0, 0}));
            spo = step.X_VT;
        }
        for (int n = 1; n <= 100; ++n) {
            const SpoStep step = free_model.advance(spo, {kAbove + Vector3d(n * 10e-6, 0, 1e-3), kUpright});
            spo = step.X_VT;
            drag[with] = step.wrench_hand_V.force.norm();
        }
    }
    EXPECT_NEAR(drag[1], drag[0], 0.02 * drag[0]);
}

TEST(GradientModel, EveryPresetSettlesAndTellsItsIterations) {
    const ContactScene scene = flatScene(Vector3d(0.2, 0.1, 1).normalized());
    for (const Preset preset : {Preset::kFast, Preset::kBalanced, Preset::kExact}) {
        GradientModel model(GradientConfig{}, scene.world(), toolOf(scene), 1e-3);
        model.setAccuracy(presetSettings(preset));
        Pose spo{kAbove, kUpright};
        const Pose device{kAbove - Vector3d(0, 0, 1e-3), kUpright};
        const SpoStep first = model.advance(spo, device);
        EXPECT_GE(first.iterations, 1u);
        EXPECT_LE(first.iterations, uint32_t(presetSettings(preset).iterations));
        const SpoStep step = settle(model, first.X_VT, device);
        EXPECT_NEAR(step.wrench_hand_V.force.norm(), 2.8, 0.4);
        EXPECT_GT(step.candidates, 0u);
    }
}

// Sweeps bound how deep a step may go, not whether the tool may move: also with a coarse grid of distances.
TEST(GradientModel, AToolOfAGridPressesAndLeavesLikeOneOfShapes) {
    const ContactScene scene = flatScene();
    GradientConfig config;
    SpoTool tool = toolOf(scene);
    tool.burr.radius = kRadius / 2;  // halves the trust radius
    constexpr int kTicks = 200;
    double force[2] = {};
    for (const ToolDistance distance : {ToolDistance::kAnalytic, ToolDistance::kGrid}) {
        GradientModel model(config, scene.world(), tool, 1e-3);
        model.setAccuracy({.tool_distance = distance, .sdf_refinement = 1, .iterations = 8});
        Pose spo{kAbove + Vector3d(0, 0, 0.5e-3), kUpright};
        SpoStep step;
        for (int n = 0; n < 2 * kTicks; ++n) {  // 0.1 m/s, which is swept, down and up again
            const double way = std::min(2e-3, 1e-4 * (n < kTicks ? n : 2 * kTicks - n));
            step = model.advance(spo, {kAbove + Vector3d(0, 0, 0.5e-3 - way), kUpright});
            spo = step.X_VT;
            if (n == kTicks - 1) force[int(distance)] = step.wrench_hand_V.force.z();
        }
        EXPECT_NEAR(spo.position.z(), kAbove.z() + 0.5e-3, 0.3e-3);
        EXPECT_EQ(step.contacts, 0u);
    }
    EXPECT_NEAR(force[0], force[1], 0.05 * force[0]);
    EXPECT_GT(force[0], 3);
}

TEST(GradientModel, NoSpeedTunnelsThroughAWallOfOneVoxel) {
    const double h = 0.125e-3, top = 4.3e-3;
    const auto wall = [=](const Vector3d& p) { return std::abs(p.z() - top + h / 2) - h / 2; };
    const ContactScene scene(cubeGeometry(65, h), wall,
                             {SphereShape{{0, 0, 0}, 1e-3}, CapsuleShape{{0, 0, 0}, {0, 9e-3, 0}, 0.8e-3}});
    for (const bool has_ccd : {true, false})
        for (const double speed : {0.5, 10.0, 500.0}) {
            GradientConfig config;
            config.max_speed = speed;
            config.max_angular_speed = 1e3;
            GradientModel model(config, scene.world(), toolOf(scene, 1e-3), 1e-3);
            AccuracySettings settings;
            settings.continuous_collision = has_ccd;
            model.setAccuracy(settings);
            Pose spo{{4e-3, 4e-3, 7e-3}, kUpright};
            const Pose device{{4e-3, 4e-3, -50e-3}, kUpright};
            for (int n = 0; n < 300; ++n) {
                const SpoStep step = model.advance(spo, device);
                spo = step.X_VT;
                ASSERT_GT(spo.position.z(), top) << speed;
                ASSERT_TRUE(step.wrench_hand_V.isFinite());
            }
            EXPECT_LT(spo.position.z(), top + 1e-3);  // it did arrive
        }
}

TEST(GradientModel, NeverGivesANonFiniteResult) {
    const ContactScene scene = flatScene();
    GradientModel model(GradientConfig{}, scene.world(), toolOf(scene), 1e-3);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Pose spo{kAbove, kUpright};
    for (int n = 0; n < 3000; ++n) {
        const double far = n % 50 == 0 ? 1 : 3e-3;
        const Pose device{kAbove + far * Vector3d(uniform(random), uniform(random), uniform(random)),
                          randomRotation(random)};
        const SpoStep step = model.advance(spo, device);
        ASSERT_TRUE(step.X_VT.isFinite());
        ASSERT_TRUE(step.wrench_hand_V.isFinite());
        ASSERT_LE(step.wrench_hand_V.force.norm(), 24 * (1 + 1e-9));  // F_m of either spring
        spo = step.X_VT;
    }
}

// What is begun is ended: a batch of 64 blocks of 64 points, the cutting of patches into samples, and the
// pass over the candidates in hand, of which there are at most a quarter of the budget, once for the sweep
// and once for the step.
TEST(GradientModel, ATickEndsSoonAfterItsBudgetWhateverItMeets) {
    const ContactScene scene = flatScene();
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const size_t most_point_tests : {1'000u, 200'000u}) {
        GradientConfig config;
        config.most_point_tests = most_point_tests;
        GradientModel model(config, scene.world(), toolOf(scene), 1e-3);
        Pose spo{kAbove, kUpright};
        double most = 0;
        int overflows = 0;
        for (int n = 0; n < 2000; ++n) {
            const Pose device{kAbove + 2e-3 * Vector3d(uniform(random), uniform(random), uniform(random) - 1),
                              kUpright};
            const SpoStep step = model.advance(spo, device);
            most = std::max(most, step.budget_share);
            overflows += step.has_contact_overflow;
            spo = step.X_VT;
        }
        EXPECT_LT(most * double(most_point_tests),
                  1.5 * double(most_point_tests) + 64 * 64 + 4 * AccuracySettings{}.most_samples);
        EXPECT_EQ(overflows > 0, most_point_tests == 1'000);
        EXPECT_GT(most, 0.02);
    }
}

// Each Newton step is a small part of the one before: most find their candidates among those of a step
// before.
TEST(GradientModel, AHandThatStartsAtOnceIsNotFollowedWithAGatheringForEachStep) {
    const ContactScene scene = flatScene();
    const Pose pressed{kAbove - Vector3d(0, 0, 0.5e-3), kUpright};
    for (const auto& [jump, most] : {std::pair(0.1e-3, 3u), {0.2e-3, 3u}, {0.4e-3, 4u}}) {
        GradientModel model(GradientConfig{}, scene.world(), toolOf(scene), 1e-3);
        const SpoStep at_rest = settle(model, {kAbove, kUpright}, pressed);
        EXPECT_EQ(at_rest.gatherings, 1u);
        const SpoStep step =
            model.advance(at_rest.X_VT, {pressed.position + jump * Vector3d(0.6, 0, -0.8), kUpright});
        EXPECT_GE(step.iterations, 3u);
        EXPECT_LE(step.gatherings, most) << jump;
    }
}

// All points of a flat end round alike, so that the energy rises by its rounding where nothing is left to
// gain: no part of such a step is worth a try.
TEST(GradientModel, AFlatEndPressedHardEndsItsSolveWhereTheEnergysRoundingDoes) {
    constexpr double kEnd = 2.5e-3, kHalf = 4e-3;
    const ContactScene scene{cubeGeometry(49, 0.125e-3),
                             halfSpace({3e-3, 3e-3, 3.01e-3}, Vector3d(0.004, 0.002, 1).normalized()),
                             {CylinderShape{{0, -kHalf, 0}, {0, kHalf, 0}, kEnd}},
                             {.levels = {{1}}}};
    GradientConfig config;
    config.coupling.translation_stiffness = 1e6;
    config.coupling.rotation_stiffness = 100;
    config.coupling.damping_time = 0;
    const SpoTool drill{&scene.tool, {.radius = kEnd}, 1000};
    GradientModel model(config, scene.world(), drill, 1e-3);
    Pose spo{{3e-3, 3e-3, 3.01e-3 + kHalf}, kUpright};
    double most_share = 0, force = 0;
    int stalled = 0;
    for (int n = 0; n < 400; ++n) {
        const Vector3d pressed(3e-3, 3e-3, 3.01e-3 + kHalf - 0.37e-6 * n);
        const SpoStep step = model.advance(spo, {pressed, kUpright});
        stalled += step.has_stalled;
        most_share = std::max(most_share, step.budget_share);
        force = std::max(force, step.wrench_hand_V.force.z());
        spo = step.X_VT;
    }
    EXPECT_LE(stalled, 4);
    EXPECT_LT(most_share, 0.025);
    EXPECT_GT(force, 100);
}

TEST(GradientModel, EnergyNeverRisesUnderAHandAtRest) {
    const ContactScene scene = flatScene(Vector3d(0.4, -0.2, 1).normalized());
    GradientModel model(GradientConfig{}, scene.world(), toolOf(scene), 1e-3);
    Pose spo{kAbove + Vector3d(0, 0, 2e-3), kUpright};
    const Pose device = Pose{kAbove - Vector3d(0, 0, 2e-3), kUpright}.incremented({0, 0, 0}, {0.3, 0.1, 0.2});
    double before = 1e9;
    for (int n = 0; n < 100; ++n) {
        spo = model.advance(spo, device).X_VT;
        EXPECT_LE(model.energy(), before * (1 + 1e-5));
        before = model.energy();
    }
}

// The force steps are those of a slow slide over a flat face: 0.3 mm voxels, k_t 1000 N/m, 5 mm/s, burr 1 to
// 3 mm.
TEST(GradientModel, SlidingOverAFlatFaceIsSmooth) {
    for (const double radius : {1e-3, 2e-3, 3e-3})
        for (const Vector3d& normal : {Vector3d(0, 0, 1), Vector3d(0.3, 0.1, 1), Vector3d(1, 1, 1)}) {
            const Vector3d n = normal.normalized(), along = n.unitOrthogonal();
            const Vector3d middle(4.83e-3, 4.79e-3, 4.81e-3);
            const ContactScene scene(cubeGeometry(33, kVoxel), halfSpace(middle, n),
                                     {SphereShape{{0, 0, 0}, radius}});
            GradientConfig config;
            config.coupling.translation_stiffness = 1000;
            GradientModel model(config, scene.world(), toolOf(scene, radius), 1e-3);
            Pose spo{middle + radius * n - 1.2e-3 * along, kUpright};
            const auto device = [&](int tick) {
                return Pose{middle + (radius - 1e-3) * n + (-1.2e-3 + 5e-6 * std::max(0, tick - 50)) * along,
                            kUpright};
            };
            Vector3d force_before = Vector3d::Zero();
            double largest = 0;
            for (int tick = 0; tick < 530; ++tick) {
                const SpoStep step = model.advance(spo, device(tick));
                spo = step.X_VT;
                if (tick > 60) largest = std::max(largest, (step.wrench_hand_V.force - force_before).norm());
                force_before = step.wrench_hand_V.force;
            }
            EXPECT_LE(largest, 0.02) << radius << " " << normal.transpose();
            EXPECT_GT(force_before.norm(), 0.5);
        }
}

TEST(GradientModel, TorqueGoesOnSmoothlyBeyondHalfATurn) {
    const ContactScene scene = flatScene();
    GradientConfig config;
    config.max_angular_speed = 1e-9;  // a tool that cannot turn: the hand turns alone
    GradientModel model(config, scene.world(), toolOf(scene), 1e-3);
    const Pose spo{kAbove + Vector3d(0, 0, 3e-3), kUpright};
    Vector3d before = Vector3d::Zero();
    for (double degrees = 0; degrees < 200; degrees += 0.1) {
        const Pose device{spo.position, expRotation({0, 0, degrees * M_PI / 180}) * kUpright};
        const Vector3d torque = model.advance(spo, device).wrench_hand_V.torque;
        if (degrees > 179) {
            EXPECT_LT((torque - before).norm(), 0.01 * before.norm()) << degrees;
        }
        before = torque;
    }
}

}  // namespace
}  // namespace bonemill

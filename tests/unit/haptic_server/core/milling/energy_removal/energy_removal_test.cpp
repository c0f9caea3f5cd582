#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/milling_rig.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::kKrpm;
using test::MillingRig;
using test::RigConfig;

constexpr double kPress = 3;      // N
constexpr double kLeading = 2e5;  // N/m: a hand that feeds

const Vector3d kDown = -Vector3d::UnitZ();
// The tool's axis, which is y in T, lies along these.
const Eigen::Quaterniond kAlongX(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
const Eigen::Quaterniond kUpright(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()));
const Eigen::Quaterniond kOblique(Eigen::AngleAxisd(M_PI / 4, Vector3d(1, 0.3, 0).normalized()));

RigConfig sideways() {
    RigConfig config;
    config.rotation = kAlongX;
    return config;
}

// The burr stands on the block's top, off the voxels' planes.
Vector3d onTop(const MillingRig& rig) {
    return rig.center() + Vector3d(31e-6, -17e-6, rig.config.burr.radius);
}

// Sums of the ticks and the mesh agree: ∫ P dt, Σ u ΔV, and the volume that is missing in the drawn surface.
void expectBalance(const MillingRig& rig, double specific_energy, double tolerance = 0.01) {
    const double work = rig.work();
    ASSERT_GT(work, 0);
    EXPECT_NEAR(rig.removedEnergy() / work, 1, tolerance);
    EXPECT_NEAR(rig.removedVolume() * specific_energy / work, 1, tolerance);
}

TEST(EnergyRemoval, SpendsTheWorkOfFrictionOnTheBone) {
    struct Case {
        Vector3d spacing_mm;
        Density iso;
        double ramp;
        Eigen::Quaterniond rotation;
    };
    const Case cases[] = {{{0.125, 0.125, 0.125}, test::kTestIso, 2, kAlongX},
                          {{0.25, 0.25, 0.25}, test::kTestIso, 1, kOblique},
                          {{0.1, 0.15, 0.2}, test::kTestIso, 2, kOblique},
                          {{0.125, 0.125, 0.125}, 9000, 2, kAlongX},
                          {{0.125, 0.125, 0.125}, 50000, 6, kUpright}};
    for (const Case& c : cases) {
        RigConfig config;
        config.spacing = 1e-3 * c.spacing_mm;
        config.iso = c.iso;
        config.ramp = c.ramp;
        config.rotation = c.rotation;
        MillingRig rig(config);
        rig.press(0.15, onTop(rig), kDown, kPress);
        EXPECT_GT(rig.removedVolume(), 0.5e-9);
        expectBalance(rig, config.removal.specific_energy);
    }
}

TEST(EnergyRemoval, KeepsTheBalanceAlongAGroove) {
    RigConfig config;
    config.rotation = kOblique;
    config.hand_stiffness = kLeading;
    MillingRig rig(config);
    rig.feed(0.1, onTop(rig) - Vector3d(1e-3, 0, 0), {0, 0, -6e-3});
    rig.feed(0.25, rig.position(), {8e-3, 2e-3, -1e-3});
    EXPECT_GT(rig.removedVolume(), 2e-9);
    expectBalance(rig, config.removal.specific_energy);
}

TEST(EnergyRemoval, DoesNotDependOnTheTickRate) {
    double slowest = 0;
    for (const double rate : {500.0, 1000.0, 2000.0, 4000.0}) {
        RigConfig config = sideways();
        config.rate = rate;
        MillingRig rig(config);
        rig.press(0.15, onTop(rig), kDown, kPress);
        if (slowest == 0) slowest = rig.removedVolume();
        EXPECT_NEAR(rig.removedVolume() / slowest, 1, 0.02) << rate;
    }
}

TEST(EnergyRemoval, LivesThroughPeriodsWithoutATick) {
    double first = 0;
    for (const int periods : {1, 4}) {
        RigConfig config = sideways();
        config.periods = periods;
        MillingRig rig(config);
        rig.press(0.2, onTop(rig), kDown, kPress);
        if (first == 0) first = rig.removedVolume();
        EXPECT_NEAR(rig.removedVolume() / first, 1, 0.05) << periods;
        expectBalance(rig, config.removal.specific_energy, 0.02);
    }
}

TEST(EnergyRemoval, DoesNotDependOnTheVoxels) {
    for (const Eigen::Quaterniond& rotation : {kAlongX, kOblique}) {
        double coarse = 0;
        for (const double voxel : {0.25e-3, 0.125e-3}) {
            RigConfig config;
            config.rotation = rotation;
            config.spacing.setConstant(voxel);
            MillingRig rig(config);
            rig.press(0.2, onTop(rig), kDown, kPress);
            if (coarse == 0) coarse = rig.removedVolume();
            EXPECT_NEAR(rig.removedVolume() / coarse, 1, 0.025) << voxel;
        }
    }
}

// u = 0.3 J/mm³, μ_c = 0.5, v_c = 10 m/s and 6 mm² fed at 10 mm/s make 3.6 N, 60 mm³/s, 18 W and 2.9
// mN·m. The side of a cylinder has one speed all over. On a wall of 2 x 3 mm it is bent, but ∫ p dA = v/c
// ∫ cos θ dA. What its edges carry, p_e all over the bent area, comes on top of force, power and torque:
// the energy per volume is u + u_1/h. The wall's rim, a voxel wide, falls with its neighbours and carries no
// edges: what that takes off goes with the voxel.
TEST(EnergyRemoval, MeetsTheCheckValue) {
    constexpr double kCoarse = 0.125e-3, kFine = 0.0625e-3, kRim = 2.6e3;  // m, m, N per m of voxel
    struct Case {
        double edge, feed, voxel;  // N/m, m/s, m
    };
    for (const Case& c : {Case{0, 10e-3, kCoarse}, Case{3e3, 10e-3, kCoarse}, Case{3e3, 4e-3, kCoarse},
                          Case{1e4, 16e-3, kCoarse}, Case{3e3, 10e-3, kFine}}) {
        RigConfig config;
        config.spacing.setConstant(c.voxel);
        config.size = {5e-3, 5e-3, 3e-3};
        config.wall = {3e-3, 2e-3};
        config.rotation = kAlongX;
        config.burr = {.kind = BurrKind::kCylinder, .radius = 1.61e-3, .length = 4e-3, .friction = 0.5};
        config.burr.speed = 10 / config.burr.radius;
        config.removal.specific_energy = 0.3e9;
        config.removal.fluted_edge = c.edge;
        config.hand_stiffness = kLeading;
        MillingRig rig(config);
        const double kRunIn = 1e-3 / c.feed, kTime = 0.05;
        const Vector3d velocity(0, 0, -c.feed);
        rig.feed(kRunIn, onTop(rig), velocity);
        const double before = rig.removedVolume();
        rig.feed(kTime, onTop(rig) + kRunIn * velocity, velocity);
        const double force = rig.mean(kTime, [](const TickRecord& r) { return r.effects.burr_force; });
        const double power = rig.mean(kTime, [](const TickRecord& r) { return r.effects.removal_power; });
        const double friction = rig.mean(kTime, [](const TickRecord& r) { return r.effects.cutting_power; });
        const double times = c.feed / 10e-3, bent = 6e-6 * 1.61 * std::asin(1 / 1.61);
        const double rubbing = c.edge / (2 * M_PI * config.burr.radius) * bent;
        const double of_rubbing = config.burr.rubbing_friction * 10;  // W/N
        const double all = 18 * times + of_rubbing * rubbing, rim = c.edge > 0 ? kRim * c.voxel : 0;
        EXPECT_NEAR(force, 3.6 * times + rubbing, 0.02 * (3.6 * times + rubbing) + rim)
            << c.edge << ' ' << c.feed;
        EXPECT_NEAR(power / (18 * times), 1, 0.02) << c.edge << ' ' << c.feed;
        EXPECT_NEAR(friction, all, 0.02 * all + of_rubbing * rim) << c.edge << ' ' << c.feed;
        EXPECT_NEAR((rig.removedVolume() - before) / kTime / (60e-9 * times), 1, 0.02) << c.edge;
        if (c.edge == 0) {
            EXPECT_NEAR(friction, power, 1e-4 * power);
        }
    }
}

// The flat end of a drill, f deep per turn: thrust R (E + f u/μ_c), torque R² (μ_e E + f u)/2, whatever the
// speed.
TEST(EnergyRemoval, ADrillHasTheThrustAndTorqueOfItsFeedPerTurn) {
    for (const double feed : {1e-3, 4e-3}) {
        RigConfig config;
        config.rotation = kUpright;
        config.burr = {.kind = BurrKind::kCylinder, .grit = BurrGrit::kDrill, .radius = 1e-3, .length = 4e-3};
        config.burr.speed = 2 * kKrpm;
        config.removal = test::kEnergyRemoval;
        config.hand_stiffness = 1e6;
        MillingRig rig(config);
        const Vector3d on_top = onTop(rig) + Vector3d(0, 0, config.burr.length / 2 - config.burr.radius);
        rig.feed(0.6e-3 / feed, on_top, feed * kDown);
        const double time = 0.2e-3 / feed, per_turn = 2 * M_PI * feed / config.burr.speed;
        const double u = config.removal.drill_energy_factor * config.removal.specific_energy;
        const double thrust = 1e-3 * (config.removal.drill_edge + per_turn * u / config.burr.friction);
        const double torque =
            0.5e-6 * (config.burr.rubbing_friction * config.removal.drill_edge + per_turn * u);
        const auto mean = [&](auto&& figure) { return rig.mean(time, figure); };
        EXPECT_NEAR(mean([](const TickRecord& r) { return r.f_hand_W[2]; }) / thrust, 1, 0.05) << feed;
        EXPECT_NEAR(
            mean([](const TickRecord& r) { return r.effects.cutting_power; }) / config.burr.speed / torque, 1,
            0.1)
            << feed;
    }
}

// A ball fed along its own axis has p = v cos θ u / (μ Ω ρ), so that ∫ p dA = 2 π ρ_rim v u / (μ Ω).
TEST(EnergyRemoval, ThePoleOfABallGoesThrough) {
    constexpr double kFeed = 3e-3;
    RigConfig config;
    config.rotation = kUpright;
    config.hand_stiffness = kLeading;
    MillingRig rig(config);
    rig.feed(0.25, onTop(rig), kFeed * kDown);
    const double speed = -(rig.records.back().p_WT[2] - rig.records[rig.records.size() - 51].p_WT[2]) / 0.05;
    EXPECT_NEAR(speed, kFeed, 0.05 * kFeed);
    const double depth = rig.center().z() + config.burr.radius - rig.position().z();
    const double rim = std::sqrt(depth * (2 * config.burr.radius - depth));
    const double expected =
        2 * M_PI * rim * kFeed * config.removal.specific_energy / (config.burr.friction * config.burr.speed);
    EXPECT_NEAR(rig.records.back().effects.burr_force / expected, 1, 0.1);
}

// Pressed along its axis with force F it sinks in at F μ Ω / (2 π R u (θ/2 + sin 2θ / 4)), θ at the rim.
TEST(EnergyRemoval, ABallSinksIntoAFlatBlockAtTheRateOfItsPower) {
    RigConfig config;
    config.rotation = kUpright;
    MillingRig rig(config);
    rig.press(0.25, onTop(rig), kDown, kPress);
    const double R = config.burr.radius, top = rig.center().z() + R;
    const double rate =
        config.burr.friction * config.burr.speed / (2 * M_PI * R * config.removal.specific_energy);
    size_t n = 0;
    while (top - rig.records[n].p_WT[2] < 0.1e-3) ++n;
    double depth = top - rig.records[n].p_WT[2];
    const double from = depth;
    for (; n < rig.records.size(); ++n) {
        const double theta = std::acos(1 - depth / R);
        const double force = rig.records[n].f_hand_W[2];
        depth += 1e-3 * force * rate / (theta / 2 + std::sin(2 * theta) / 4);
    }
    EXPECT_GT(depth, 0.5e-3);
    EXPECT_NEAR((top - rig.position().z() - from) / (depth - from), 1, 0.05);
}

TEST(EnergyRemoval, AdvancesSmoothlyUnderASteadyForce) {
    for (const Eigen::Quaterniond& rotation : {kAlongX, kUpright, kOblique}) {
        RigConfig config;
        config.rotation = rotation;
        MillingRig rig(config);
        rig.press(0.25, onTop(rig), kDown, kPress);
        const double force = rig.mean(0.2, [](const TickRecord& r) { return r.effects.burr_force; });
        for (size_t n = 50; n < rig.records.size(); ++n) {
            const TickRecord &r = rig.records[n], &before = rig.records[n - 1];
            EXPECT_LT(r.p_WT[2], before.p_WT[2]) << n;
            EXPECT_NEAR(double(r.effects.burr_force), double(before.effects.burr_force), 0.02 * force) << n;
        }
    }
}

TEST(EnergyRemoval, NeedsSpinAndPedal) {
    RigConfig still = sideways();
    still.burr.speed = 0;
    for (const uint32_t buttons : {uint32_t(kButtonRemove), 0u, uint32_t(kButtonAdd)}) {
        MillingRig turning(sideways()), standing(still);
        turning.press(0.05, onTop(turning), kDown, kPress, buttons);
        standing.press(0.05, onTop(standing), kDown, kPress, buttons);
        EXPECT_EQ(turning.removedVolume() > 0, buttons == kButtonRemove);
        EXPECT_EQ(standing.removedVolume(), 0);
        EXPECT_GT(standing.records.back().contacts, 0u);
        EXPECT_EQ(standing.records.back().effects.removal_power, 0);
    }
}

TEST(EnergyRemoval, TurnsBothWays) {
    RigConfig reversed = sideways();
    reversed.burr.speed = -reversed.burr.speed;
    MillingRig one(sideways()), other(reversed);
    for (MillingRig* rig : {&one, &other}) rig->press(0.05, onTop(*rig), kDown, kPress);
    EXPECT_GT(one.removedVolume(), 0);
    EXPECT_EQ(one.removedVolume(), other.removedVolume());
}

TEST(EnergyRemoval, BelowTheThresholdItOnlyRubs) {
    RigConfig config = sideways();
    config.removal.threshold_pressure = 100e6;
    MillingRig rubbing(config);
    rubbing.press(0.05, onTop(rubbing), kDown, kPress);
    EXPECT_EQ(rubbing.removedVolume(), 0);
    EXPECT_GT(rubbing.records.back().effects.cutting_power, 1);

    config.removal.threshold_pressure = 0.3e6;
    MillingRig cutting(config);
    cutting.press(0.15, onTop(cutting), kDown, kPress);
    double friction = 0;
    for (const TickRecord& r : cutting.records) friction += double(r.effects.cutting_power) / config.rate;
    EXPECT_GT(cutting.work(), 0.2 * friction);
    EXPECT_LT(cutting.work(), 0.9 * friction);
    expectBalance(cutting, config.removal.specific_energy);
}

TEST(EnergyRemoval, DiamondsTakeMoreEnergy) {
    RigConfig config = sideways();
    config.burr.grit = BurrGrit::kDiamond;
    config.removal.diamond_energy_factor = 2;
    MillingRig rig(config);
    rig.press(0.15, onTop(rig), kDown, kPress);
    expectBalance(rig, 2 * config.removal.specific_energy);
}

// The bone below is harder: the burr slows down there, and the balance counts each by its own.
TEST(EnergyRemoval, KnowsHardBoneFromSoft) {
    RigConfig config = sideways();
    config.is_hard_below = 0.5e-3;
    MillingRig rig(config);
    rig.press(0.25, onTop(rig), kDown, kPress);
    EXPECT_NEAR(rig.removedEnergy() / rig.work(), 1, 0.01);
    const auto speedAt = [&](double depth) {
        size_t n = 0;
        while (rig.center().z() + config.burr.radius - rig.records[n].p_WT[2] < depth) ++n;
        return (rig.records[n].p_WT[2] - rig.records[n + 10].p_WT[2]) / 10e-3;
    };
    EXPECT_LT(speedAt(0.65e-3), 0.6 * speedAt(0.4e-3));
}

// Edges carry more in proportion in harder bone: a hand that cuts the soft only rubs on the hard below. The
// burr comes to that as its area grows, the slower the less it lacks.
TEST(EnergyRemoval, StopsOnBoneHardEnoughToCarryItsEdges) {
    RigConfig config = sideways();
    config.is_hard_below = 0.3e-3;
    config.removal.fluted_edge = 2e3;
    MillingRig rig(config);
    rig.press(0.6, onTop(rig), kDown, 1);
    const double depth = rig.center().z() + config.burr.radius - rig.position().z();
    EXPECT_GT(depth, 0.28e-3);
    EXPECT_LT(depth, 0.4e-3);
    const double before = rig.removedVolume();
    rig.press(0.1, rig.position(), kDown, 1);
    EXPECT_LT(rig.removedVolume() - before, 2e-12);
}

// The burr is pushed faster than the surface may move in a tick, and through a thin wall: all stays finite,
// and the rest is solid.
TEST(EnergyRemoval, SurvivesWhatNoHandDoes) {
    RigConfig config = sideways();
    config.wall = {4e-3, 0.4e-3};
    config.hand_stiffness = kLeading;
    MillingRig rig(config);
    rig.feed(0.05, onTop(rig), {0, 0, -60e-3});
    rig.feed(0.1, rig.position(), {30e-3, 5e-3, 15e-3});
    ASSERT_EQ(rig.records.size(), 150u);
    for (const TickRecord& r : rig.records) {
        EXPECT_TRUE(std::isfinite(r.effects.burr_force));
        EXPECT_FALSE(r.faults & (kFaultSolve | kFaultShellOverflow | kFaultVolumeFull)) << r.tick;
    }
    EXPECT_GT(rig.removedVolume(), 0);
    EXPECT_LT(rig.removedVolume() * config.removal.specific_energy, 1.01 * rig.work());
    const auto meshes = test::meshAll(rig.bone.volume, rig.bone.lattice);
    EXPECT_TRUE(checkMesh(meshes, MeshGrid(rig.bone.volume, rig.bone.lattice)).isClosed());
}

// Where there is only time for some of the contacts at once, the leaves around the burr take turns, in the
// air of a pit as well.
TEST(EnergyRemoval, LeavesTakeTurnsUnderABurrWithTooManyContacts) {
    constexpr size_t kFewContacts = 80;
    RigConfig config = sideways(), in_turn = config;
    in_turn.most_milled_cells = kFewContacts * EnergyRemovalConfig::kCellsPerContact;
    MillingRig at_once(config), turning(in_turn);
    for (MillingRig* rig : {&at_once, &turning}) rig->press(0.3, onTop(*rig), kDown, kPress);
    EXPECT_GT(at_once.records.back().contacts, 2 * kFewContacts);
    EXPECT_NEAR(turning.removedVolume() / at_once.removedVolume(), 1, 0.02);
    expectBalance(turning, config.removal.specific_energy, 0.02);  // the account holds some ticks of it
    for (size_t n = 100; n < turning.records.size(); ++n)
        EXPECT_NEAR(turning.records[n].f_hand_W[2], kPress, 0.02 * kPress) << n;
}

// The shell is coarse where there is only time for coarser points.
TEST(EnergyRemoval, KeepsTheBalanceOnACoarseShell) {
    for (const int factor : {2, 3}) {
        RigConfig config = sideways();
        config.shell_factor = factor;
        MillingRig rig(config);
        rig.press(0.15, onTop(rig), kDown, kPress);
        expectBalance(rig, config.removal.specific_energy);
    }
}

// The shell and the ranges are those of a bone that is made anew.
TEST(EnergyRemoval, LeavesShellAndRangesUpToDate) {
    RigConfig config;
    config.rotation = kOblique;
    config.spacing = {0.1e-3, 0.15e-3, 0.2e-3};
    MillingRig rig(config);
    rig.press(0.05, onTop(rig), kDown, kPress);
    const LeafLattice lattice(rig.bone.volume, rig.bone.lattice.leafCells());
    const PointShell shell(rig.bone.volume, lattice, {.levels = {{1}}, .spare_points = 0});
    EXPECT_EQ(rig.bone.shell.pointCount(0), shell.pointCount(0));
    for (int level = 0; level < lattice.levelCount(); ++level)
        for (uint32_t node = 0; node < lattice.nodeCount(level); ++node) {
            EXPECT_EQ(rig.bone.lattice.range(level, node).min, lattice.range(level, node).min);
            EXPECT_EQ(rig.bone.lattice.range(level, node).max, lattice.range(level, node).max);
        }
}

}  // namespace
}  // namespace bonemill

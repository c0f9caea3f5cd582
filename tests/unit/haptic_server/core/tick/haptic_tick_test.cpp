#include "haptic_server/core/tick/haptic_tick.h"

#include <gtest/gtest.h>

#include <limits>

#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/surface/mesh/mesh_check.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "tests/support/led_tick.h"
#include "tests/support/milling_config.h"
#include "tests/support/test_bodies.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

constexpr double kVoxel = 0.125e-3;
constexpr double kBurr = 1e-3;
constexpr double kTop = 6e-3;  // bone fills z < kTop (V)

// The slab lies in a volume whose frame V is turned and shifted against W.
struct Bench {
    explicit Bench(const Pose& X_WV = {{0.1, -0.2, 0.3}, expRotation({0.4, -0.9, 0.2})})
        : bone(slab(X_WV), Eigen::Vector3i::Constant(16), ShellConfig{}),
          tool(test::sphereToolModel(kBurr, kVoxel)) {
        config.tool = {&tool, {.radius = kBurr}};
        config.accuracy = presetSettings(Preset::kThesis2012);
    }
    static VoxelVolume slab(const Pose& X_WV) {
        VolumeGeometry geometry = test::cubeGeometry(64, kVoxel);
        geometry.X_WV = X_WV;
        return test::bodyVolume(geometry, test::halfSpace({0, 0, kTop}, Eigen::Vector3d::UnitZ()));
    }
    Pose atV(const Eigen::Vector3d& p_V) const {
        return bone.volume.geometry().X_WV * Pose{p_V, Eigen::Quaterniond::Identity()};
    }
    Eigen::Vector3d inV(const double (&p_W)[3]) const {
        return bone.volume.geometry().X_WV.inverse() * Eigen::Vector3d(p_W[0], p_W[1], p_W[2]);
    }
    std::vector<TickRecord> run(const std::vector<DeviceInput>& inputs) {
        FixedTick tick(config, bone);
        return test::lead(tick, inputs);
    }
    double boneVolume() const {
        std::vector<NodeMesh> meshes;
        Mesher mesher(bone.volume, bone.lattice);
        mesher.pass([&](NodeMesh&& mesh) { meshes.push_back(std::move(mesh)); });
        return meshVolume(meshes, MeshGrid(bone.volume, bone.lattice));
    }

    FixedTickConfig config = test::millingConfig();
    BoneModel bone;
    ToolModel tool;
};

double forceSizeOf(const TickRecord& record) {
    return Eigen::Map<const Eigen::Vector3d>(record.f_hand_W).norm();
}

const Eigen::Vector3d kStart(3.95e-3, 4.05e-3, kTop + kBurr + 0.3e-3);

TEST(HapticTick, FreeSpaceIsFree) {
    Bench bench;
    const Pose start = bench.atV(kStart);
    const auto records = bench.run(test::straightPath(start, start.position, 50, 0));
    ASSERT_EQ(records.size(), 50u);
    for (const TickRecord& r : records) {
        EXPECT_EQ(r.contacts, 0u);
        EXPECT_LT(Eigen::Vector3d(r.f_hand_W).norm(), 1e-9);
        EXPECT_EQ(r.faults, 0u);
    }
}

TEST(HapticTick, PressingPushesBackAlongTheSurfaceNormalInTheWorld) {
    Bench bench;
    const Pose start = bench.atV(kStart);
    const Eigen::Vector3d end = bench.atV(kStart - Eigen::Vector3d(0, 0, 1.0e-3)).position;
    auto inputs = test::straightPath(start, end, 200, 0);
    inputs.insert(inputs.end(), 500, inputs.back());
    const TickRecord last = bench.run(inputs).back();
    const Eigen::Vector3d up_W = bench.bone.volume.geometry().X_WV.rotation * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d force(last.f_hand_W[0], last.f_hand_W[1], last.f_hand_W[2]);
    EXPECT_GT(last.contacts, 0u);
    EXPECT_GT(force.dot(up_W), 0.5);
    EXPECT_GT(force.dot(up_W) / force.norm(), 0.99);
    // In equilibrium what the hand feels is the coupling's stretch.
    const double stretch = (Eigen::Vector3d(last.p_WT[0], last.p_WT[1], last.p_WT[2]) - end).norm();
    EXPECT_NEAR(force.norm(), 3000 * stretch, 1e-6);
}

TEST(HapticTick, SpeedLimitHoldsTheToolBack) {
    Bench bench;
    const Pose start = bench.atV(kStart);
    auto inputs = test::straightPath(start, start.position, 2, 0);
    inputs[1].X_WT_device.position.x() += 2e-3;
    const auto records = bench.run(inputs);
    EXPECT_TRUE(records[1].faults & kFaultMotionClamped);
    const double moved = std::abs(records[1].p_WT[0] - records[0].p_WT[0]);
    EXPECT_NEAR(moved, 0.5 * 0.5e-3, 1e-9);  // (1 - alpha) * 0.5 m/s * 1 ms
}

TEST(HapticTick, BadDevicePosesAreRefusedAndNothingNonFiniteComesOut) {
    Bench bench;
    const Pose start = bench.atV(kStart);
    auto inputs = test::straightPath(start, start.position, 7, kButtonRemove);
    inputs[2].X_WT_device.position.x() = std::numeric_limits<double>::quiet_NaN();
    inputs[3].X_WT_device.rotation.coeffs().setZero();
    inputs[4].X_WT_device.position.x() = std::numeric_limits<double>::infinity();
    inputs[5].X_WT_device.position.x() = 1e160;  // finite, but its square is not
    const auto records = bench.run(inputs);
    ASSERT_EQ(records.size(), inputs.size());
    for (size_t n = 0; n < records.size(); ++n) {
        EXPECT_EQ(bool(records[n].faults & kFaultBadDevicePose), n >= 2 && n <= 5) << n;
        for (const double v : records[n].f_hand_W) EXPECT_TRUE(std::isfinite(v));
        for (const double v : records[n].p_WT) EXPECT_TRUE(std::isfinite(v));
    }
}

// V's origin, where the tool stands until then, is inside the bone.
TEST(HapticTick, BeforeTheFirstGoodPoseNothingIsMilledOrFelt) {
    for (const Preset preset : {Preset::kThesis2012, Preset::kBalanced}) {
        Bench bench;
        bench.config.accuracy = presetSettings(preset);
        const Pose start = bench.atV(kStart);
        auto inputs = test::straightPath(start, start.position, 60, kButtonRemove);
        for (size_t n = 0; n < 50; ++n)
            inputs[n].X_WT_device.position.x() = std::numeric_limits<double>::quiet_NaN();
        for (const TickRecord& r : bench.run(inputs)) {
            EXPECT_EQ(bool(r.faults & kFaultBadDevicePose), r.tick < 50) << r.tick;
            EXPECT_EQ(r.removed_voxels, 0u) << presetName(preset) << " " << r.tick;
            if (r.tick < 50) {
                EXPECT_EQ(forceSizeOf(r), 0) << presetName(preset) << " " << r.tick;
            }
        }
    }
}

// The hand was put elsewhere while its tool was held by the bone.
TEST(HapticTick, AHandThatIsPutSomewhereTakesItsToolAlongWithoutAStepOfForce) {
    Bench bench;
    bench.config.accuracy = presetSettings(Preset::kBalanced);
    const Pose start = bench.atV(kStart);
    const Pose X_VT_upright{{4e-3, 4e-3, 1e-3},
                            rotationBetween(Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ())};
    auto inputs =
        test::straightPath(start, bench.atV(kStart - Eigen::Vector3d(0, 0, 1.3e-3)).position, 300, 0);
    const auto hold = [&](const Pose& X_WT, uint32_t placements) {
        DeviceInput input = inputs.back();
        input.X_WT_device = X_WT;
        input.placements = placements;
        inputs.insert(inputs.end(), 200, input);
    };
    hold(bench.atV(kStart + Eigen::Vector3d(-2e-3, 0, 0.5e-3)), 1);
    hold(bench.bone.volume.geometry().X_WV * X_VT_upright, 2);
    const auto records = bench.run(inputs);
    EXPECT_GT(forceSizeOf(records[299]), 1);
    EXPECT_LT((bench.inV(records[300].p_WT) - kStart - Eigen::Vector3d(-2e-3, 0, 0.5e-3)).norm(), 1e-9);
    for (size_t n = 301; n < records.size(); ++n)
        EXPECT_LT(std::abs(forceSizeOf(records[n]) - forceSizeOf(records[n - 1])),
                  1.001 * HandLimits::kForceRate * bench.config.dt)
            << n;
    EXPECT_LT(forceSizeOf(records[499]), 1e-6);
    for (size_t n = 500; n < records.size(); ++n)
        EXPECT_GT(bench.inV(records[n].p_WT).z(), kTop + 0.7 * kBurr) << "in bone it has no place: " << n;
    EXPECT_NEAR(bench.inV(records.back().p_WT).x(), 4e-3, 1e-4);
}

TEST(HapticTick, StaleDeviceMillsNothingAndForceFollowsTheRamp) {
    Bench bench;
    const Pose start = bench.atV(kStart - Eigen::Vector3d(0, 0, 1e-3));
    auto inputs = test::straightPath(start, start.position, 300, 0);
    for (size_t n = 200; n < 300; ++n) {
        inputs[n].buttons = kButtonRemove;
        inputs[n].is_stale = true;
        inputs[n].stale_factor = 0.25;
    }
    const auto records = bench.run(inputs);
    EXPECT_GT(forceSizeOf(records[199]), 0.1);
    EXPECT_NEAR(forceSizeOf(records[299]), 0.25 * forceSizeOf(records[199]),
                0.05 * forceSizeOf(records[199]));
    EXPECT_TRUE(records[250].faults & kFaultStaleDevice);
    for (const TickRecord& r : records) EXPECT_EQ(r.removed_voxels, 0u);
}

// The bone is as hard as no number can say: thesis_2012 finds no equilibrium in it.
TEST(HapticTick, WithoutAnEquilibriumTheForceFadesAndComesBackAlongTheRamp) {
    Bench bench;
    bench.config.contact.point_stiffness = 1e308;
    AccuracySwitch accuracy(presetSettings(Preset::kBalanced));
    const ToolSwitch tools({bench.config.tool});
    HapticTick tick(bench.config, {bench.bone}, {tools, accuracy});
    const Pose start = bench.atV(kStart), pressed = bench.atV(kStart - Eigen::Vector3d(0, 0, 1.3e-3));
    const auto lead = [&](const Pose& from, int ticks) {
        return test::lead(tick, test::straightPath(from, pressed.position, ticks, 0));
    };
    lead(start, 200);
    const double held = forceSizeOf(lead(pressed, 200).back());
    EXPECT_GT(held, 2);

    accuracy.choose(AccuracySwitch::choiceOf(Preset::kThesis2012));
    lead(pressed, 1);
    const int ticks = int(std::lround(HandLimits::kFade / bench.config.dt));
    double last = held;
    for (const TickRecord& r : lead(pressed, ticks)) {
        EXPECT_TRUE(r.faults & kFaultSolve);
        EXPECT_NEAR(last - forceSizeOf(r), held / ticks, 1e-3 * held);
        last = forceSizeOf(r);
    }
    EXPECT_LT(last, 1e-9);
    for (const TickRecord& r : lead(pressed, 100)) EXPECT_LT(forceSizeOf(r), 1e-9);

    accuracy.choose(AccuracySwitch::choiceOf(Preset::kBalanced));
    for (const TickRecord& r : lead(pressed, 200)) {
        EXPECT_LE(forceSizeOf(r) - last, 1.001 * HandLimits::kForceRate * bench.config.dt);
        last = forceSizeOf(r);
    }
    EXPECT_NEAR(last, held, 0.01 * held);
}

TEST(HapticTick, WorkBeyondTheDeadlineIsAnOverrun) {
    Bench bench;
    const Pose start = bench.atV(kStart);
    auto inputs = test::straightPath(start, start.position, 2, 0);
    inputs[1].deadline_ns = 1;  // long past
    const auto records = bench.run(inputs);
    EXPECT_FALSE(records[0].faults & kFaultOverrun);
    EXPECT_TRUE(records[1].faults & kFaultOverrun);
}

TEST(HapticTick, PausedMillingTakesNothingButIsFelt) {
    Bench bench;
    BoneHistory history(bench.bone);
    history.pauseMilling(true);
    FixedTick tick(bench.config, bench.bone, &history);
    const Pose start = bench.atV(kStart);
    const Eigen::Vector3d end = bench.atV(kStart - Eigen::Vector3d(0, 0, 1e-3)).position;
    const auto records = test::lead(tick, test::straightPath(start, end, 400, kButtonRemove));
    for (const TickRecord& r : records) EXPECT_EQ(r.removed_voxels, 0u);
    EXPECT_GT(records.back().contacts, 0u);
}

// What the mesher is told is where the bone really changed, no more and no less.
TEST(HapticTick, TheRecordHoldsTheBoxOfTheMilledVoxels) {
    Bench bench;
    const Pose start = bench.atV(kStart - Eigen::Vector3d(0, 0, 1e-3));
    auto inputs = test::straightPath(start, start.position, 60, 0);
    for (size_t n = 30; n < 60; ++n) inputs[n].buttons = kButtonRemove;
    FixedTick tick(bench.config, bench.bone);
    test::ScriptedIo io(inputs);
    const VoxelVolume& volume = bench.bone.volume;
    const auto densities = [&] {
        std::vector<Density> all;
        test::forEachVoxel(test::wholeBox(volume),
                           [&](int i, int j, int k) { all.push_back(volume.at(i, j, k)); });
        return all;
    };
    size_t cuts = 0;
    for (std::vector<Density> before = densities(); io.step(tick); before = densities()) {
        IndexBox changed;
        auto old = before.begin();
        test::forEachVoxel(test::wholeBox(volume), [&](int i, int j, int k) {
            if (volume.at(i, j, k) != *old++) changed.include({i, j, k});
        });
        const Cut& cut = io.records.back().cut;
        ASSERT_EQ(cut.isEmpty(), changed.isEmpty());
        if (changed.isEmpty()) continue;
        ++cuts;
        EXPECT_EQ(cut.voxels().min, changed.min);
        EXPECT_EQ(cut.voxels().max, changed.max);
        EXPECT_EQ(cut.start_ns, io.records.back().start_ns);
    }
    EXPECT_GT(cuts, 5u);
    EXPECT_LE(cuts, 30u);
}

// The corridor is where the trajectory says: a straight feed into a slab leaves a round-bottomed hole.
TEST(HapticTick, CorridorHasTheVolumeOfTheSweptBurr) {
    Bench bench;
    const double volume_before = bench.boneVolume();
    const Pose start = bench.atV(kStart);
    const Eigen::Vector3d end = bench.atV(kStart - Eigen::Vector3d(0, 0, 4.3e-3)).position;
    auto inputs = test::straightPath(start, end, 4000, kButtonRemove);
    inputs.insert(inputs.end(), 1000, inputs.back());  // dwell: the bottom wears until the springs relax
    const auto records = bench.run(inputs);
    double removed = 0;
    for (const TickRecord& r : records) removed += r.removed;
    const TickRecord& last = records.back();
    EXPECT_LT((bench.inV(last.p_WT) - (kStart - Eigen::Vector3d(0, 0, 4.3e-3))).norm(), 0.05e-3);
    const double depth = kTop - bench.inV(last.p_WT).z();  // of the burr centre below the surface
    const double swept = M_PI * kBurr * kBurr * depth + 2.0 / 3 * M_PI * std::pow(kBurr, 3);
    // The corridor is straight if the tool kept to the axis; what it wandered widens the corridor.
    double wander = 0;
    for (const TickRecord& r : records)
        wander = std::max(wander, (bench.inV(r.p_WT) - kStart).head<2>().norm());
    EXPECT_LT(wander, 0.02e-3);
    const double slack = 0.02 + 2 * wander / kBurr;
    EXPECT_NEAR(removed / swept, 1, slack);
    EXPECT_NEAR((volume_before - bench.boneVolume()) / swept, 1, slack);
}

// Ticks go on with the old settings until the new ones' contact points are up to date, whatever is
// milled meanwhile.
TEST(HapticTick, ChangedSettingsAreTakenUpWhenTheirPointsAreReady) {
    Bench bench;
    BoneModel bone(Bench::slab({}), Eigen::Vector3i::Constant(8), {.levels = {{1}, {2}, {3}}});
    AccuracySettings coarse = presetSettings(Preset::kBalanced);
    coarse.shell_factor = 2;
    AccuracySwitch accuracy(coarse);
    const ToolSwitch tools({bench.config.tool});
    HapticTick tick(bench.config, {bone}, {tools, accuracy});
    const auto factor = [&] { return bone.shell.scalingFactor(bone.shell.followed()); };
    const Pose start{kStart, Eigen::Quaterniond::Identity()};
    const auto mill = [&](int ticks) {
        test::lead(tick,
                   test::straightPath(start, kStart - Eigen::Vector3d(0, 0, 2e-3), ticks, kButtonRemove));
    };
    mill(400);
    EXPECT_EQ(factor(), 2);
    EXPECT_GT(bone.shell.staleLeaves(0), 2u);
    accuracy.choose(AccuracySwitch::choiceOf(Preset::kBalanced));
    mill(1);
    EXPECT_EQ(factor(), 2);
    accuracy.choose(AccuracySwitch::choiceOf(Preset::kThesis2012));  // the newest choice counts
    mill(200);
    EXPECT_EQ(factor(), 3);
    EXPECT_EQ(bone.shell.staleLeaves(2), 0u);
    EXPECT_GT(bone.shell.staleLeaves(0), 0u);
    const PointShell fresh(bone.volume, bone.lattice, {.levels = {{3}}});
    EXPECT_EQ(bone.shell.pointCount(2), fresh.pointCount(0));
}

TEST(HapticTick, TwoRunsAreBitIdentical) {
    const auto run_once = [] {
        Bench bench;
        const Pose start = bench.atV(kStart);
        const Eigen::Vector3d end = bench.atV(kStart - Eigen::Vector3d(1e-3, 0.3e-3, 3e-3)).position;
        return bench.run(test::straightPath(start, end, 1500, kButtonRemove));
    };
    const auto a = run_once(), b = run_once();
    ASSERT_EQ(a.size(), 1500u);
    ASSERT_EQ(b.size(), a.size());
    for (size_t n = 0; n < a.size(); ++n) {
        ASSERT_EQ(0, std::memcmp(a[n].p_WT, b[n].p_WT, sizeof a[n].p_WT)) << n;
        ASSERT_EQ(0, std::memcmp(a[n].f_hand_W, b[n].f_hand_W, sizeof a[n].f_hand_W)) << n;
        ASSERT_EQ(a[n].removed_voxels, b[n].removed_voxels);
    }
}

}  // namespace
}  // namespace bonemill

// A tick allocates nothing and takes no lock: replaced heap and lock functions count that over everything a
// tick does.
#include <gtest/gtest.h>

#include <limits>

#include "haptic_server/core/bone/checkpoints.h"
#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/laws/all_laws.h"
#include "tests/support/milling_config.h"
#include "tests/support/rt_guard/rt_probe.h"
#include "tests/support/scripted_io.h"
#include "tests/support/test_bodies.h"
#include "tests/support/typical_effects.h"
#include "tests/unit/haptic_server/core/tick/tool_bench.h"

namespace bonemill {
namespace {

class TickIsRtSafe : public testing::Test {
  protected:
    TickIsRtSafe()
        : bone_(test::bodyVolume(test::cubeGeometry(64, 0.125e-3),
                                 test::halfSpace({0, 0, 5e-3}, Eigen::Vector3d::UnitZ())),
                Eigen::Vector3i::Constant(16), ShellConfig{}),
          tool_(test::sphereToolModel(1e-3, 0.125e-3)),
          history_(bone_),
          tools_({{&tool_}}),
          accuracy_(AccuracySettings{}),
          tick_(test::millingConfig(), {bone_, &history_}, {tools_, accuracy_}) {}

    // Runs the inputs under the probe; what the test itself keeps is allocated before.
    void expectQuiet(const std::vector<DeviceInput>& inputs) { expectQuiet(tick_, inputs); }
    template <class Tick>
    void expectQuiet(Tick& tick, const std::vector<DeviceInput>& inputs) {
        test::ScriptedIo io(inputs);
        RtProbe probe;
        io.lead(tick);
        probe.stop();
        EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
        EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
        records_ = io.records;
        EXPECT_EQ(records_.size(), inputs.size());
    }
    size_t removedVoxels() const {
        size_t sum = 0;
        for (const TickRecord& record : records_) sum += record.removed_voxels;
        return sum;
    }
    static Pose at(double z) { return {{4e-3, 4e-3, z}, Eigen::Quaterniond::Identity()}; }

    BoneModel bone_;
    ToolModel tool_;
    BoneHistory history_;
    ToolSwitch tools_;
    AccuracySwitch accuracy_;
    HapticTick tick_;
    std::vector<TickRecord> records_;
};

TEST_F(TickIsRtSafe, WhileMillingAndAddingAndResetting) {
    expectQuiet(test::straightPath(at(6.2e-3), {4e-3, 4e-3, 3e-3}, 1000, kButtonRemove));
    EXPECT_GT(removedVoxels(), 1000u);
    expectQuiet(test::straightPath(at(3e-3), {4e-3, 4e-3, 6e-3}, 300, kButtonAdd));
    history_.restore();
    expectQuiet(test::straightPath(at(6.2e-3), {4e-3, 4e-3, 6.2e-3}, 500, 0));
    EXPECT_FALSE(history_.isRestoring());
}

TEST_F(TickIsRtSafe, WhileEnergyRemovesBoneOfSeveralKinds) {
    FixedTickConfig config;
    config.tool = {&tool_, {.speed = 6000}};
    config.effects.energy_removal = test::kEnergyRemoval;
    config.effects.energy_removal->specific_energy = 0.05e9;
    config.effects.energy_removal->density_exponent = 1.5;
    config.effects.properties = std::make_shared<const BoneProperties>(
        bone_.volume, [](const Eigen::Vector3i& v) { return MaterialId(v.x() % 2); });
    config.effects.materials = {{}, {.specific_energy = 0.03e9}};
    FixedTick tick(config, bone_, &history_);
    expectQuiet(tick, test::straightPath(at(6.2e-3), {4e-3, 4e-3, 3e-3}, 1000, kButtonRemove));
    EXPECT_GT(removedVoxels(), 1000u);
    history_.restore();
    expectQuiet(tick, test::straightPath(at(6.2e-3), {4e-3, 4e-3, 6.2e-3}, 500, kButtonRemove));
    EXPECT_FALSE(history_.isRestoring());
}

TEST_F(TickIsRtSafe, AsThesis2012) {
    FixedTickConfig config = test::millingConfig();
    config.tool.model = &tool_;
    config.accuracy = presetSettings(Preset::kThesis2012);
    FixedTick tick(config, bone_, &history_);
    expectQuiet(tick, test::straightPath(at(6.2e-3), {4e-3, 4e-3, 3e-3}, 1000, kButtonRemove));
    EXPECT_GT(removedVoxels(), 1000u);
    expectQuiet(tick, test::straightPath(at(3e-3), {4e-3, 4e-3, 6e-3}, 300, kButtonAdd));
}

TEST_F(TickIsRtSafe, AsEveryLawOfAnotherSchool) {
    FixedTickConfig config = test::millingConfig();
    config.tool.model = &tool_;
    config.laws = allLaws();
    for (const Preset preset : kComparedLaws) {
        SCOPED_TRACE(std::string(presetName(preset)));
        config.accuracy = presetSettings(preset);
        const size_t removed_before = removedVoxels();
        FixedTick tick(config, bone_, &history_);
        expectQuiet(tick, test::straightPath(at(6.2e-3), {4e-3, 4e-3, 3e-3}, 1000, kButtonRemove));
        EXPECT_GT(removedVoxels(), removed_before + 200u);
        history_.restore();
        expectQuiet(tick, test::straightPath(at(6.2e-3), {4e-3, 4e-3, 6.2e-3}, 500, 0));
        EXPECT_FALSE(history_.isRestoring());
    }
}

TEST_F(TickIsRtSafe, WhileLevelsArePreparedAndTakenUp) {
    BoneModel bone(test::bodyVolume(test::cubeGeometry(64, 0.125e-3),
                                    test::halfSpace({0, 0, 5e-3}, Eigen::Vector3d::UnitZ())),
                   Eigen::Vector3i::Constant(16), {.levels = {{1}, {2}, {3}}});
    AccuracySwitch accuracy(presetSettings(Preset::kBalanced));
    HapticTick tick(test::millingConfig(), {bone}, {tools_, accuracy});
    for (const Preset preset : {Preset::kFast, Preset::kThesis2012, Preset::kExact}) {
        accuracy.choose(AccuracySwitch::choiceOf(preset));
        expectQuiet(tick, test::straightPath(at(6.2e-3), {4e-3, 4e-3, 3e-3}, 300, kButtonRemove));
        EXPECT_EQ(bone.shell.scalingFactor(bone.shell.followed()), presetSettings(preset).shell_factor);
    }
}

TEST_F(TickIsRtSafe, WhileFaultsHappen) {
    auto inputs = test::straightPath(at(6e-3), {4e-3, 4e-3, 5.5e-3}, 100, kButtonRemove);
    inputs[20].X_WT_device.position.setConstant(std::numeric_limits<double>::quiet_NaN());
    inputs[30].X_WT_device.position.x() += 2e-3;  // quicker than the tool may move
    inputs[35].X_WT_device.position.x() += 1;     // than any hand
    inputs[40].is_stale = true;
    inputs[50].X_WT_device.rotation.coeffs().setZero();
    expectQuiet(inputs);
    EXPECT_TRUE(tick_.latchedFaults() & kFaultBadDevicePose);
    EXPECT_TRUE(tick_.latchedFaults() & kFaultMotionClamped);
}

TEST(ToolSwitchIsRtSafe, WhilePressingAndMilling) {
    for (const uint32_t buttons : {0u, uint32_t(kButtonRemove)}) {
        test::ToolBench bench;
        const Pose from = test::SwitchingBench::at(6.2e-3);
        test::ScriptedIo io(test::straightPath(from, {4.05e-3, 3.95e-3, 4.8e-3}, 1000, buttons));
        RtProbe probe;
        bench.runChanging(io);
        probe.stop();
        EXPECT_EQ(probe.heapCalls(), 0u) << probe.firstCall();
        EXPECT_EQ(probe.lockCalls(), 0u) << probe.firstCall();
        EXPECT_EQ(io.records.size(), 1000u);
        EXPECT_GT(io.records.back().contacts + bench.history.missingVoxels(), 0);
    }
}

TEST_F(TickIsRtSafe, WhileACheckpointIsRestored) {
    Checkpoints checkpoints(history_, bone_);
    expectQuiet(test::straightPath(at(6.2e-3), {4e-3, 4e-3, 5e-3}, 500, kButtonRemove));
    checkpoints.save(0);
    const int64_t missing = history_.missingVoxels();
    EXPECT_GT(missing, 0);
    expectQuiet(test::straightPath(at(5e-3), {4e-3, 4e-3, 4e-3}, 500, kButtonRemove));
    EXPECT_GT(history_.missingVoxels(), missing);
    checkpoints.restore(1);
    expectQuiet(test::straightPath(at(6.2e-3), {4e-3, 4e-3, 6.2e-3}, 500, 0));
    EXPECT_FALSE(history_.isRestoring());
    EXPECT_EQ(history_.missingVoxels(), missing);
}

}  // namespace
}  // namespace bonemill

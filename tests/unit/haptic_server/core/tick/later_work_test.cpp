// What does not fit into a tick's period waits for one of the next, and is made good there.
#include <gtest/gtest.h>

#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/core/tick/tick_budget.h"
#include "tests/support/test_bodies.h"
#include "tests/support/typical_effects.h"

namespace bonemill {
namespace {

TEST(LaterWork, WaitsWhileItDoesNotFitButNotForEver) {
    LaterWork work(1e-3);
    EXPECT_TRUE(work.fits(LaterWork::kMilling, 0.5));
    for (int n = 0; n < 50; ++n) work.took(LaterWork::kMilling, 0.4);
    EXPECT_TRUE(work.fits(LaterWork::kMilling, 0.3));
    for (int round = 0; round < 3; ++round) {
        for (int n = 0; n < LaterWork::kMostWaits; ++n) EXPECT_FALSE(work.fits(LaterWork::kMilling, 0.5));
        EXPECT_TRUE(work.fits(LaterWork::kMilling, 0.5));
    }
    EXPECT_TRUE(work.fits(LaterWork::kHeat, 0.7)) << "which takes nothing";
}

TEST(LaterWork, OneTickThatWasInterruptedPutsNothingOffForLong) {
    LaterWork work(1e-3);
    for (int n = 0; n < 1000; ++n) work.took(LaterWork::kMilling, 0.1);
    work.took(LaterWork::kMilling, 50);
    EXPECT_TRUE(work.fits(LaterWork::kMilling, 0.4));
    for (int n = 0; n < 300; ++n) work.took(LaterWork::kMilling, 0.1);
    EXPECT_TRUE(work.fits(LaterWork::kMilling, 0.65));
}

TEST(LaterWork, MillingThatTakesLongWorksOnFewerCellsUntilItIsQuick) {
    LaterWork work(1e-3);
    for (int n = 0; n < 20; ++n) work.took(LaterWork::kMilling, 0.6);
    EXPECT_EQ(work.millingThrift(), 1);
    for (int n = 0; n < 300; ++n) work.took(LaterWork::kMilling, 0.6);
    EXPECT_EQ(work.millingThrift(), kMostThrift);
    for (int n = 0; n < 5000; ++n) work.took(LaterWork::kMilling, 0.25);
    EXPECT_EQ(work.millingThrift(), kMostThrift) << "twice as many cells would take too long";
    for (int n = 0; n < 5000; ++n) work.took(LaterWork::kMilling, 0.1);
    EXPECT_EQ(work.millingThrift(), 0);
}

// A machine whose force is out after `force` of the period, and whose milling takes `milling` of it.
class SteadyMachine final : public TickIo {
  public:
    SteadyMachine(double force, double milling) : force_(force), milling_(milling) {}
    bool read(DeviceInput& input) noexcept override {
        start_ns_ += kPeriodNs;
        now_ = force_;
        input = {};
        input.X_WT_device = X_WT_hand;
        input.buttons = kButtonRemove;
        input.start_ns = start_ns_;
        input.deadline_ns = start_ns_ + kPeriodNs;
        input.decisions = decisions;
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return start_ns_ + int64_t(force_ * kPeriodNs); }
    // It is asked for before and after milling, and so on.
    int64_t now() noexcept override {
        const double asked_at = now_;
        now_ += milling_;
        return start_ns_ + int64_t(asked_at * kPeriodNs);
    }

    Pose X_WT_hand;
    const TickDecisions* decisions = nullptr;

  private:
    static constexpr int64_t kPeriodNs = 1'000'000;
    double force_, milling_, now_ = 0;
    int64_t start_ns_ = 0;
};

struct MilledSlab {
    explicit MilledSlab(const EffectConfigs& effects)
        : bone(test::bodyVolume(test::cubeGeometry(64, 0.125e-3),
                                test::halfSpace({0, 0, 5e-3}, Eigen::Vector3d::UnitZ())),
               Eigen::Vector3i::Constant(16), {.levels = {{1}, {2}}}),
          tool(test::sphereToolModel(1e-3, 0.125e-3)) {
        config.tool.model = &tool;
        config.tool.burr.radius = 1e-3;
        config.tool.burr.speed = 2000;
        config.effects = effects;
    }
    struct Run {
        std::vector<TickRecord> records;
        double removed = 0;  // m³
        int put_off = 0, without_heat = 0;
        uint32_t faults = 0;
        std::vector<Density> left;
    };
    // The hand goes down into the slab and then along it. With decisions it is a replay.
    Run run(SteadyMachine machine, const std::vector<TickRecord>* recorded = nullptr) {
        FixedTick tick(config, bone);
        Run result;
        for (int n = 0; n < 1500; ++n) {
            const double down = 6.1e-3 - 0.4e-6 * std::min(n, 500),
                         along = 3e-3 + 2e-6 * std::max(0, n - 500);
            machine.X_WT_hand = {{along, 4e-3, down}, Eigen::Quaterniond::Identity()};
            if (recorded) machine.decisions = &(*recorded)[size_t(n)].input.decisions;
            const TickRecord record = *tick.tick(machine);
            result.put_off += record.input.decisions.is_milling_put_off;
            result.without_heat += record.input.decisions.is_heat_put_off;
            result.faults |= record.faults;
            result.removed += record.removed;
            result.records.push_back(record);
        }
        forEachIndex({Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(63)}, [&](const Eigen::Vector3i& v) {
            result.left.push_back(bone.volume.at(v.x(), v.y(), v.z()));
        });
        return result;
    }

    FixedTickConfig config;
    BoneModel bone;
    ToolModel tool;
};

class PutOff : public testing::TestWithParam<bool> {
  public:
    static EffectConfigs effects() {
        EffectConfigs effects;
        effects.thermal = test::kThermal;
        if (GetParam())
            effects.energy_removal = test::kEnergyRemoval;
        else
            effects.time_removal = test::kTimeRemoval;
        return effects;
    }
};

TEST_P(PutOff, MillingIsMadeGood) {
    const MilledSlab::Run quick = MilledSlab(effects()).run({0.1, 0.1});
    const MilledSlab::Run slow = MilledSlab(effects()).run({0.4, 0.5});
    const MilledSlab::Run none = MilledSlab(EffectConfigs{}).run({0.1, 0.1});
    EXPECT_EQ(quick.put_off, 0);
    EXPECT_GT(slow.put_off, 300);
    EXPECT_TRUE(slow.faults & kFaultMillingCutShort);
    EXPECT_GT(quick.removed, 0);
    // A burr that mills in every fourth tick only comes a little later.
    EXPECT_NEAR(slow.removed, quick.removed, 0.08 * quick.removed);
    double off = 0, of_none = 0;  // N, summed
    for (size_t n = 501; n < slow.records.size(); ++n) {
        off += std::abs(slow.records[n].f_hand_W[2] - quick.records[n].f_hand_W[2]);
        of_none += std::abs(none.records[n].f_hand_W[2] - quick.records[n].f_hand_W[2]);
    }
    EXPECT_LT(off, 0.2 * of_none);
}

TEST_P(PutOff, AReplayPutsOffTheSame) {
    const MilledSlab::Run slow = MilledSlab(effects()).run({0.4, 0.5});
    const MilledSlab::Run again = MilledSlab(effects()).run({0, 0}, &slow.records);
    EXPECT_EQ(again.put_off, slow.put_off);
    EXPECT_EQ(again.left, slow.left);
    EXPECT_GT(slow.without_heat, 300);
    for (size_t n = 0; n < slow.records.size(); ++n) {
        ASSERT_EQ(again.records[n].effects.temperature, slow.records[n].effects.temperature) << n;
        for (int axis = 0; axis < 3; ++axis)
            ASSERT_EQ(again.records[n].f_hand_W[axis], slow.records[n].f_hand_W[axis]) << n;
    }
}

INSTANTIATE_TEST_SUITE_P(LaterWork, PutOff, testing::Bool(),
                         [](const auto& info) { return info.param ? "ByEnergy" : "ByTime"; });

}  // namespace
}  // namespace bonemill

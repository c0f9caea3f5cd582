// A tick that fills its period again and again samples the bone less finely, and more finely again later.
#include <gtest/gtest.h>

#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/core/tick/tick_budget.h"
#include "tests/support/scripted_io.h"
#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

constexpr double kCapDt = 1e-3;
constexpr int kCapSecond = 1000;  // ticks

size_t capAfter(SampleCap& cap, int ticks, double load, size_t samples) {
    for (int n = 0; n < ticks; ++n)
        cap.after({.whole = load, .force = 0, .samples = samples, .is_work_put_off = false});
    return cap.most();
}

TEST(SampleCap, ThreeSlowTicksSoonAfterEachOtherHalveTheSamples) {
    SampleCap cap(kCapDt);
    EXPECT_EQ(capAfter(cap, 2, 0.8, 1000), SIZE_MAX);
    EXPECT_EQ(capAfter(cap, 1, 0.8, 1000), 500u);
    EXPECT_EQ(capAfter(cap, 3, 0.8, 500), 250u);
    EXPECT_EQ(capAfter(cap, 30, 0.8, 250), SampleCap::kFewest);
}

TEST(SampleCap, OneSlowTickNowAndThenIsSomethingElse) {
    SampleCap cap(kCapDt);
    for (int n = 0; n < 100; ++n) {
        EXPECT_EQ(capAfter(cap, 1, 5, 1000), SIZE_MAX) << n;
        EXPECT_EQ(capAfter(cap, 100, 0.5, 1000), SIZE_MAX) << n;
    }
    // Nor has a tick with few samples too many of them.
    EXPECT_EQ(capAfter(cap, 1000, 0.9, SampleCap::kFewest), SIZE_MAX);
}

TEST(SampleCap, ComesBackAStepASecondWhileTicksAreQuick) {
    SampleCap cap(kCapDt);
    ASSERT_EQ(capAfter(cap, 3, 0.8, 2000), 1000u);
    EXPECT_EQ(capAfter(cap, 10 * kCapSecond, 0.5, 1000), 1000u);
    EXPECT_EQ(capAfter(cap, kCapSecond + 1, 0.1, 1000), 2000u);
    EXPECT_EQ(capAfter(cap, 10 * kCapSecond, 0.1, 1000), SIZE_MAX);
}

// For whatever reason a force is long, its samples are what can give way; a short one is not the reason.
TEST(SampleCap, WorkThatIsPutOffForALongForceCountsAsASlowTick) {
    SampleCap cap(kCapDt);
    const auto putOff = [&](double force) {
        cap.after({.whole = force + 0.1, .force = force, .samples = 1000, .is_work_put_off = true});
    };
    for (int n = 0; n < 100; ++n) putOff(0.35);
    EXPECT_EQ(cap.most(), SIZE_MAX);
    for (int n = 0; n < 3; ++n) putOff(0.5);
    EXPECT_EQ(cap.most(), 500u);
}

// A machine on which a sample takes so long, whatever machine it runs on.
class SlowMachine final : public TickIo {
  public:
    explicit SlowMachine(int64_t ns_per_sample) : ns_per_sample_(ns_per_sample) {}
    bool read(DeviceInput& input) noexcept override {
        start_ns_ += kPeriodNs;
        input = {};
        input.X_WT_device = X_WT_hand;
        input.start_ns = start_ns_;
        input.deadline_ns = start_ns_ + kPeriodNs;
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return start_ns_; }
    // The samples of this tick will have been about as many as those of the last one.
    int64_t now() noexcept override { return start_ns_ + ns_per_sample_ * int64_t(last.candidates); }

    Pose X_WT_hand;
    TickRecord last{};

  private:
    static constexpr int64_t kPeriodNs = 1'000'000;
    int64_t ns_per_sample_, start_ns_ = 0;
};

struct PressedSlab {
    PressedSlab()
        : bone(test::bodyVolume(test::cubeGeometry(48, 0.25e-3),
                                test::halfSpace({0, 0, 5e-3}, Eigen::Vector3d::UnitZ())),
               Eigen::Vector3i::Constant(16), {.levels = {{1}, {2}}}),
          tool(test::sphereToolModel(2e-3, 0.25e-3)) {
        config.tool.model = &tool;
        config.accuracy.sample_spacing = 20 * kMicrometre;
        config.accuracy.most_samples = 4096;
    }
    static Pose at(double z) { return {{6e-3, 6e-3, z}, Eigen::Quaterniond::Identity()}; }

    FixedTickConfig config;
    BoneModel bone;
    ToolModel tool;
};

TEST(SampleCap, ATickOnASlowMachineSamplesLessFinelyAndFeelsTheSame) {
    PressedSlab slab;
    FixedTick tick(slab.config, slab.bone);
    SlowMachine quick(1), slow(1000);
    const auto run = [&](SlowMachine& machine, int ticks, double z) {
        machine.X_WT_hand = PressedSlab::at(z);
        for (int n = 0; n < ticks; ++n) machine.last = *tick.tick(machine);
        return machine.last;
    };
    for (int n = 0; n <= 300; ++n) run(quick, 1, 7e-3 - 1e-6 * n);
    const TickRecord whole = run(quick, 300, 6.7e-3);
    EXPECT_GT(whole.candidates, 1000u);
    EXPECT_FALSE(whole.faults & kFaultFewerSamples);

    const TickRecord fewer = run(slow, 300, 6.7e-3);
    EXPECT_LT(fewer.compute_ns, 800'000);
    EXPECT_TRUE(fewer.faults & kFaultFewerSamples);
    EXPECT_NEAR(fewer.f_hand_W[2], whole.f_hand_W[2], 0.02 * whole.f_hand_W[2]);

    const TickRecord again = run(quick, 8000, 6.7e-3);
    EXPECT_GT(again.candidates, 1000u);
    EXPECT_FALSE(again.faults & kFaultFewerSamples);
}

}  // namespace
}  // namespace bonemill

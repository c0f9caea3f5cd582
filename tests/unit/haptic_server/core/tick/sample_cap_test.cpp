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

TEST(SampleCap, WorkThatIsPutOffCountsAsASlowTick) {
    SampleCap cap(kCapDt);
    for (int n = 0; n < 3; ++n)
        cap.after({.whole = 0.5, .force = 0.1, .samples = 1000, .is_work_put_off = true});
    EXPECT_EQ(cap.most(), 500u);
}

TEST(SampleCap, SaysHowMuchTheForceMostlyTakes) {
    SampleCap cap(kCapDt);
    const auto after = [&](double force) {
        cap.after({.whole = force, .force = force, .samples = 100, .is_work_put_off = false});
        return cap.forceLoad();
    };
    for (int n = 0; n < 1000; ++n) after(0.4);
    EXPECT_NEAR(after(0.4), 0.4 * kMostForceLoad, 1);
    EXPECT_LT(after(7), AffordableShell::kTooMuchForce) << "one that was interrupted";
    int most = 0;
    for (int n = 0; n < 20; ++n) most = std::max(most, after(0.95));
    EXPECT_GE(most, AffordableShell::kTooMuchForce);
    for (int n = 0; n < 500; ++n) after(0.1);
    EXPECT_LE(after(0.1), 2);
}

// By what samples cost there are as many as there is time for, before any tick is slow.
TEST(SampleCap, AsManyAsThereIsTimeFor) {
    SampleCap cap(kCapDt);
    for (int n = 0; n < 1000; ++n)
        cap.after({.whole = 0.4, .force = 0.3, .samples = 300, .is_work_put_off = false});
    EXPECT_LE(cap.most(), 600u);
    EXPECT_GE(cap.most(), 512u);
    // A tick that was interrupted is no measure.
    SampleCap steady(kCapDt);
    for (int n = 0; n < 1000; ++n) {
        const double force = n % 100 == 0 ? 5 : 0.05;
        steady.after({.whole = force, .force = force, .samples = 1000, .is_work_put_off = false});
        EXPECT_GE(steady.most(), 4000u) << n;
    }
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

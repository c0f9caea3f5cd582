#include <gtest/gtest.h>

#include <limits>

#include "tests/support/controlled_panel.h"

namespace bonemill {
namespace {

class Plots : public testing::Test {
  protected:
    Plots() {
        status_.set_tick_p99_us(80);
        session_.status = &status_;
        session_.tool = &tool_;
        tool_.set_epoch(1);
    }
    void feel(uint64_t tick, double newtons) {
        tool_.set_tick(tick);
        tool_.clear_force_n();
        tool_.clear_torque_nm();
        for (const double part : {0.6, 0.0, 0.8}) tool_.add_force_n(part * newtons);
        for (const double part : {0.0, 0.001, 0.0}) tool_.add_torque_nm(part * newtons);
        history_.update(session_);
    }

    topics::Status status_;
    topics::ToolState tool_;
    SessionView session_;
    PlotHistory history_;
};

TEST_F(Plots, FollowForceTorqueAndTick) {
    for (uint64_t n = 1; n <= 5; ++n) feel(n, double(n));
    feel(5, 9);  // the same tick again
    EXPECT_FLOAT_EQ(history_.force().newest(), 5);
    EXPECT_FLOAT_EQ(history_.torque().newest(), 5);
    EXPECT_FLOAT_EQ(history_.tick().newest(), 80);
    feel(6, 1);
    EXPECT_FLOAT_EQ(history_.force().largest(), 5);
    EXPECT_FLOAT_EQ(history_.force().newest(), 1);
}

TEST_F(Plots, ForgetWhatIsOldAndAnotherServersPast) {
    feel(1, 7);
    for (uint64_t n = 0; n < PlotHistory::kLength; ++n) feel(n + 2, 1);
    EXPECT_FLOAT_EQ(history_.force().largest(), 1);
    tool_.set_epoch(2);
    feel(1, 0.5);
    EXPECT_FLOAT_EQ(history_.force().largest(), 0.5);
    feel(2, std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(history_.force().newest(), 0);
    tool_.clear_force_n();
    tool_.set_tick(3);
    history_.update(session_);
    EXPECT_EQ(history_.force().newest(), 0);
}

class PlotsPanel : public testing::Test, protected test::ControlledPanel {};

TEST_F(PlotsPanel, AreFoldedAtFirstAndThereWithATool) {
    switchPanel();
    layOut(1280, 2400);
    EXPECT_FALSE(panel_.find("Plots"));
    topics::ToolState tool;
    session_.tool = &tool;
    layOut(1280, 2400);
    layOut(1280, 2400);
    EXPECT_TRUE(panel_.find("Plots"));
}

}  // namespace
}  // namespace bonemill

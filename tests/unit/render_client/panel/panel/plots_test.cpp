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
    // For so long (s).
    void feel(double newtons, double seconds = PlotHistory::kStep) {
        session_.time_s += seconds;
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
    for (int n = 1; n <= 5; ++n) feel(n);
    EXPECT_FLOAT_EQ(history_.force().newest(), 5);
    EXPECT_FLOAT_EQ(history_.torque().newest(), 5);
    EXPECT_FLOAT_EQ(history_.tick().newest(), 80);
    feel(1);
    EXPECT_FLOAT_EQ(history_.force().largest(), 5);
    EXPECT_FLOAT_EQ(history_.force().newest(), 1);
}

TEST_F(Plots, AreTenSecondsLongAtAnyRateOfPictures) {
    for (const double picture_s : {0.007, 0.05, 0.4}) {
        feel(7, 0.1);
        for (double t = 0; t < 9.5; t += picture_s) feel(1, picture_s);
        EXPECT_FLOAT_EQ(history_.force().largest(), 7) << picture_s;
        feel(1, 1);
        EXPECT_FLOAT_EQ(history_.force().largest(), 1) << picture_s;
    }
}

TEST_F(Plots, ForgetAnotherServersPastAndWhatIsNoNumber) {
    feel(7);
    feel(1, 1000);  // the viewer was asleep
    EXPECT_FLOAT_EQ(history_.force().largest(), 1);
    tool_.set_epoch(2);
    feel(0.5);
    EXPECT_FLOAT_EQ(history_.force().largest(), 0.5);
    feel(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(history_.force().newest(), 0);
    tool_.clear_force_n();
    session_.time_s += 1;
    history_.update(session_);
    EXPECT_EQ(history_.force().newest(), 0);
}

class PlotsPanel : public testing::Test, protected test::ControlledPanel {};

TEST_F(PlotsPanel, AreThereWithATool) {
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

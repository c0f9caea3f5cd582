#include <gtest/gtest.h>

#include <vector>

#include "device_daemon/ares/emulator/emulated_controller.h"

namespace bonemill {
namespace {

using wire::DriveState;

// Plays the hand in periods of 1 ms and returns when (ms) something began.
class Played {
  public:
    void play(int periods, const HandScript::View& view) {
        for (int i = 0; i < periods; ++i, ++ms_) {
            const bool held = hand_.holdsEnablingSwitch(), reset = hand_.pressesReset();
            hand_.update(view, (1000 + ms_) * 1'000'000LL);
            if (!held && hand_.holdsEnablingSwitch()) pressed_ms.push_back(ms_);
            if (held && !hand_.holdsEnablingSwitch()) released_ms.push_back(ms_);
            if (!reset && hand_.pressesReset()) reset_ms.push_back(ms_);
            reset_duration_ms += hand_.pressesReset();
        }
    }
    std::vector<int> pressed_ms, released_ms, reset_ms;
    int reset_duration_ms = 0;

  private:
    HandScript hand_;
    int ms_ = 0;
};

TEST(HandScript, PressesTheSwitchAnewUntilTheHostEngagesAndThenHoldsIt) {
    Played hand;
    hand.play(100, {DriveState::kSwitchedOn, false});
    EXPECT_TRUE(hand.pressed_ms.empty());
    hand.play(700, {DriveState::kOperationEnabled, false});
    EXPECT_EQ(hand.pressed_ms, (std::vector<int>{150, 450, 750}));
    EXPECT_EQ(hand.released_ms, (std::vector<int>{400, 700}));
    hand.play(5000, {DriveState::kOperationEnabled, true});
    EXPECT_EQ(hand.pressed_ms.size(), 3u);
    EXPECT_EQ(hand.released_ms.size(), 2u);
    EXPECT_TRUE(hand.reset_ms.empty());
}

TEST(HandScript, ResetsAFaultAfterHalfASecond) {
    Played hand;
    hand.play(200, {DriveState::kOperationEnabled, true});
    hand.play(560, {DriveState::kFault, false});
    EXPECT_EQ(hand.reset_ms, std::vector<int>{700});
    EXPECT_EQ(hand.reset_duration_ms, 50);
    hand.play(1000, {DriveState::kOperationEnabled, true});
    EXPECT_EQ(hand.reset_ms.size(), 1u);
}

TEST(HandScript, ResetsAHostThatDoesNotEngage) {
    Played hand;
    hand.play(200, {DriveState::kOperationEnabled, true});
    hand.play(2000, {DriveState::kSwitchOnDisabled, false});
    EXPECT_EQ(hand.reset_ms, std::vector<int>{200 + 1499});
    hand.play(1500, {DriveState::kSwitchOnDisabled, false});
    EXPECT_EQ(hand.reset_ms.size(), 2u);
}

}  // namespace
}  // namespace bonemill

#include "device_daemon/ares/wire/drive_state.h"

#include <gtest/gtest.h>

#include "device_daemon/ares/wire/packets.h"

namespace bonemill::wire {
namespace {

DriveStateMachine readyForOrders() {
    DriveStateMachine drive;
    drive.report(0, true);
    return drive;
}

DriveStateMachine enabled() {
    DriveStateMachine drive = readyForOrders();
    for (const uint16_t word : {kControlShutdown, kControlSwitchOn, kControlEnable})
        drive.command(word, true);
    return drive;
}

TEST(DriveStateMachine, IsNotReadyUntilItsFirstPeriod) {
    DriveStateMachine drive;
    drive.command(kControlEnable, true);
    EXPECT_EQ(drive.state(), DriveState::kNotReady);
    drive.report(0, true);
    EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
}

TEST(DriveStateMachine, IsEnabledInThreeSteps) {
    DriveStateMachine drive = readyForOrders();
    drive.command(kControlEnable, true);
    EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
    drive.command(kControlShutdown, true);
    EXPECT_EQ(drive.state(), DriveState::kReady);
    drive.command(kControlSwitchOn, true);
    EXPECT_EQ(drive.state(), DriveState::kSwitchedOn);
    drive.command(kControlEnable, false);
    EXPECT_EQ(drive.state(), DriveState::kSwitchedOn) << "something speaks against it";
    drive.command(kControlEnable, true);
    EXPECT_EQ(drive.state(), DriveState::kOperationEnabled);
}

TEST(DriveStateMachine, AHostThatFollowsTheStatuswordGetsThereAndBack) {
    DriveStateMachine drive = readyForOrders();
    for (int i = 0; i < 3; ++i)
        drive.command(controlwordTowards(true, driveStateOf(drive.statusword())), true);
    EXPECT_EQ(drive.state(), DriveState::kOperationEnabled);
    drive.command(controlwordTowards(false, driveStateOf(drive.statusword())), true);
    EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
}

TEST(DriveStateMachine, LeavesAtEveryLesserOrder) {
    const std::pair<uint16_t, DriveState> cases[] = {{kControlDisable, DriveState::kSwitchOnDisabled},
                                                     {kControlQuickStop, DriveState::kQuickStop},
                                                     {kControlShutdown, DriveState::kReady},
                                                     {kControlSwitchOn, DriveState::kSwitchedOn},
                                                     {kControlEnable, DriveState::kOperationEnabled}};
    for (const auto& [word, state] : cases) {
        DriveStateMachine drive = enabled();
        drive.command(word, true);
        EXPECT_EQ(drive.state(), state) << word;
    }
}

TEST(DriveStateMachine, AQuickStopIsLeftByDisablingOnly) {
    DriveStateMachine drive = enabled();
    drive.command(kControlQuickStop, true);
    for (const uint16_t word : {kControlEnable, kControlShutdown, kControlSwitchOn})
        drive.command(word, true);
    EXPECT_EQ(drive.state(), DriveState::kQuickStop);
    drive.command(kControlDisable, true);
    EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
}

TEST(DriveStateMachine, LatchesTheFirstFaultUntilItIsResetByARisingBit) {
    DriveStateMachine drive = enabled();
    drive.command(kControlFaultReset, true);
    drive = enabled();
    drive.report(kFaultEncoder, true);
    drive.report(kFaultEncoder | kFaultAmplifier, true);
    EXPECT_EQ(drive.state(), DriveState::kFault);
    EXPECT_EQ(drive.firstFault(), kFaultEncoder);
    EXPECT_EQ(drive.activeFaults(), kFaultEncoder | kFaultAmplifier);
    drive.command(kControlFaultReset, true);
    EXPECT_EQ(drive.state(), DriveState::kFault) << "it is still there";
    drive.report(0, true);
    EXPECT_EQ(drive.firstFault(), kFaultEncoder);
    drive.command(kControlFaultReset, true);
    EXPECT_EQ(drive.state(), DriveState::kFault) << "the bit has not risen";
    drive.command(kControlDisable, true);
    drive.command(kControlFaultReset, true);
    EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
    EXPECT_EQ(drive.firstFault(), 0u);
}

TEST(DriveStateMachine, WithoutPowerItIsOff) {
    DriveStateMachine drive = enabled();
    EXPECT_TRUE(drive.statusword() & 0x10);
    drive.report(0, false);
    EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
    EXPECT_FALSE(drive.statusword() & 0x10);
}

TEST(Statusword, SaysEveryStateWhateverTheOtherBitsAre) {
    for (const DriveState state :
         {DriveState::kNotReady, DriveState::kSwitchOnDisabled, DriveState::kReady, DriveState::kSwitchedOn,
          DriveState::kOperationEnabled, DriveState::kQuickStop, DriveState::kFault}) {
        EXPECT_EQ(driveStateOf(statuswordOf(state)), state);
        EXPECT_EQ(driveStateOf(statuswordOf(state) | 0xFF90), state);
    }
    EXPECT_EQ(driveStateOf(0x0F), DriveState::kFault) << "the reaction to a fault";
}

}  // namespace
}  // namespace bonemill::wire

#include "render_client/look/hud/device_lines.h"

#include <gtest/gtest.h>

#include "common/device_messages/device_messages.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/hud/hud_lines.h"

namespace bonemill {
namespace {

topics::Device deviceIn(SafetyState state, StopCause cause = StopCause::kNone) {
    topics::Device device;
    device.set_name("Touch");
    device.set_state(uint32_t(state));
    device.set_stop_cause(uint32_t(cause));
    return device;
}
std::string stopText(const topics::Device& device) {
    const auto stop = deviceStop(device, nullptr);
    return stop ? stop->text : "";
}
std::string waitText(const topics::Device& device) {
    const auto wait = deviceWait(device, nullptr);
    return wait ? wait->text : "";
}

TEST(DeviceLines, AreTheSameLinesInEveryState) {
    topics::Device device = deviceIn(SafetyState::kEngaged);
    auto rows = deviceRows(device, nullptr);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].label, "Touch");
    EXPECT_EQ(rows[0].value, "engaged");
    EXPECT_EQ(rows[0].tone, HudTone::kPlain);
    EXPECT_EQ(rows[1].value, "\u2013") << "the device says no word of it";
    device.set_is_simulated(true);
    device.clear_name();
    rows = deviceRows(device, nullptr);
    EXPECT_EQ(rows[0].label, "Device");
    EXPECT_EQ(rows[0].value, "engaged, simulated");
    EXPECT_EQ(deviceRows(deviceIn(SafetyState::kFault, StopCause::kSpeed), nullptr).size(), 2u);
}

TEST(DeviceLines, TellWhatStiffnessWasGivenUpForTheDevice) {
    topics::Device device = deviceIn(SafetyState::kEngaged);
    device.set_coupling_share(1);
    device.set_rotation_share(1);
    EXPECT_EQ(deviceRows(device, nullptr)[1].value, "100 %, turning 100 %");
    device.set_coupling_share(0.452);
    device.set_rotation_share(0.0314);
    EXPECT_EQ(deviceRows(device, nullptr)[1].value, "45 %, turning 3.1 %");
    EXPECT_LE(deviceRows(device, nullptr)[1].value.size(), kLongestRow);
}

TEST(DeviceLines, EveryStopIsRedAndSaysWhyAndWhatToDo) {
    for (const SafetyState state : {SafetyState::kDisconnected, SafetyState::kProtectiveStop,
                                    SafetyState::kEmergencyStop, SafetyState::kFault})
        for (uint32_t cause = 1; cause < kStopCauseCount; ++cause) {
            const topics::Device device = deviceIn(state, StopCause(cause));
            EXPECT_EQ(deviceRows(device, nullptr)[0].tone, HudTone::kAlarm);
            EXPECT_EQ(deviceStop(device, nullptr)->tone, HudTone::kAlarm);
            std::vector<std::string> parts{"The Touch ", whatToDo(StopCause(cause))};
            if (std::string(nameOf(StopCause(cause))) != nameOf(state))
                parts.push_back(nameOf(StopCause(cause)));
            for (const std::string& part : parts)
                EXPECT_NE(stopText(device).find(part), std::string::npos) << stopText(device);
        }
    topics::Device fault = deviceIn(SafetyState::kFault, StopCause::kDeviceFault);
    fault.set_fault_code(17);
    EXPECT_NE(stopText(fault).find("device fault 17"), std::string::npos) << stopText(fault);
    EXPECT_EQ(stopText(deviceIn(SafetyState::kEmergencyStop)), "The Touch is in emergency stop.");
}

TEST(DeviceLines, AMouseHasNoMotorsAndANameIsNotCutShort) {
    topics::Device mouse = deviceIn(SafetyState::kFault, StopCause::kForceMismatch);
    mouse.set_kind(uint32_t(DeviceKind::kPointer));
    mouse.set_name("mouse in the viewer");
    EXPECT_EQ(stopText(mouse),
              "The mouse in the viewer is out of order. Reset it, let it go and take it again.");
    topics::Device emulator = deviceIn(SafetyState::kProtectiveStop, StopCause::kDeviceLost);
    emulator.set_name("ARES emulator (placeholder geometry)");
    EXPECT_EQ(
        stopText(emulator),
        "The ARES emulator (placeholder geometry) has stopped: device lost. Check cable and power of the "
        "device.");
}

TEST(DeviceLines, BeforeItEngagesItIsAWarningAndACauseThatIsOverIsNotSaid) {
    for (const SafetyState state :
         {SafetyState::kConnected, SafetyState::kHoming, SafetyState::kReady, SafetyState::kPaused}) {
        const topics::Device device = deviceIn(state, StopCause::kSpeed);
        EXPECT_EQ(deviceRows(device, nullptr)[0].tone, HudTone::kWarning);
        EXPECT_EQ(stopText(device), "");
        EXPECT_EQ(waitText(device), "");
    }
}

TEST(DeviceLines, ReadyAndPausedSayWhatTheyWaitFor) {
    for (const SafetyState state : {SafetyState::kReady, SafetyState::kPaused}) {
        const std::string begin = std::string("The Touch is ") + nameOf(state) + ": ";
        topics::Device waits = deviceIn(state);
        waits.set_force_waits(true);
        EXPECT_EQ(waitText(waits), begin + "move the tool away from the bone.");
        waits.set_force_waits(false);
        waits.set_abilities(kAbilityEnablingSwitch);
        EXPECT_EQ(waitText(waits), begin + "hold the enabling switch.");
        waits.set_is_enabled(true);
        EXPECT_EQ(waitText(waits),
                  state == SafetyState::kPaused ? begin + "let the switch go and press it again." : "");
    }
}

TEST(DeviceLines, TheToolsStateIsNewerAndUnknownStatesAreAlarms) {
    topics::ToolState tool;
    tool.set_device_state(uint32_t(SafetyState::kEmergencyStop));
    tool.set_stop_cause(uint32_t(StopCause::kEmergencyStop));
    const auto rows = deviceRows(deviceIn(SafetyState::kEngaged), &tool);
    EXPECT_EQ(rows[0].value, "emergency stop");
    EXPECT_EQ(deviceStop(deviceIn(SafetyState::kEngaged), &tool)->text,
              std::string("The Touch is in emergency stop. ") + whatToDo(StopCause::kEmergencyStop));
    tool.set_device_state(1000);
    EXPECT_EQ(deviceRows(deviceIn(SafetyState::kEngaged), &tool)[0].tone, HudTone::kAlarm);
}

TEST(DeviceLines, AreThereOnlyWhereAServerTellsOfADevice) {
    HudInput input;
    input.status.emplace();
    input.show_details = true;
    const size_t without = makeHud(input).details.size();
    *input.status->mutable_device() = deviceIn(SafetyState::kEngaged);
    EXPECT_EQ(makeHud(input).details.size(), without + 2);
}

}  // namespace
}  // namespace bonemill

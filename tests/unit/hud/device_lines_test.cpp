#include "render_client/hud/device_lines.h"

#include <gtest/gtest.h>

#include "common/device_messages/device_messages.h"
#include "render_client/hud/figure_text.h"
#include "render_client/hud/hud_lines.h"

namespace bonemill {
namespace {

topics::Device deviceIn(SafetyState state, StopCause cause = StopCause::kNone) {
    topics::Device device;
    device.set_name("Touch");
    device.set_state(uint32_t(state));
    device.set_stop_cause(uint32_t(cause));
    return device;
}
std::string textOf(const std::vector<HudRow>& rows) {
    std::string text;
    for (const HudRow& row : rows) text += (text.empty() ? "" : " ") + row.value;
    return text;
}

TEST(DeviceLines, AnEngagedDeviceIsOneQuietLine) {
    topics::Device device = deviceIn(SafetyState::kEngaged);
    auto rows = deviceRows(device, nullptr);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].label, "Touch");
    EXPECT_EQ(rows[0].value, "engaged");
    EXPECT_EQ(rows[0].tone, HudTone::kPlain);
    device.set_is_simulated(true);
    device.clear_name();
    rows = deviceRows(device, nullptr);
    EXPECT_EQ(rows[0].label, "Device");
    EXPECT_EQ(rows[0].value, "engaged, simulated");
}

TEST(DeviceLines, TellWhatStiffnessWasGivenUpForTheDevice) {
    topics::Device device = deviceIn(SafetyState::kEngaged);
    device.set_coupling_share(1);
    device.set_rotation_share(1);
    EXPECT_EQ(deviceRows(device, nullptr).size(), 1u);
    device.set_coupling_share(0.452);
    device.set_rotation_share(0.0314);
    const auto rows = deviceRows(device, nullptr);
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[1].value, "stiffness at 45 %");
    EXPECT_EQ(rows[2].value, "turning stiffness at 3.1 %");
    EXPECT_LE(rows[2].value.size(), kLongestRow);
    EXPECT_EQ(deviceRows(deviceIn(SafetyState::kPaused), nullptr).size(), 1u);
}

TEST(DeviceLines, EveryStopIsRedAndSaysWhyAndWhatToDo) {
    for (const SafetyState state : {SafetyState::kDisconnected, SafetyState::kProtectiveStop,
                                    SafetyState::kEmergencyStop, SafetyState::kFault})
        for (uint32_t cause = 1; cause < kStopCauseCount; ++cause) {
            const auto rows = deviceRows(deviceIn(state, StopCause(cause)), nullptr);
            EXPECT_EQ(rows[0].value, nameOf(state));
            for (const HudRow& row : rows) {
                EXPECT_EQ(row.tone, HudTone::kAlarm);
                EXPECT_LE(row.value.size(), 32u) << row.value;
            }
            EXPECT_NE(textOf(rows).find(nameOf(StopCause(cause))), std::string::npos) << textOf(rows);
            EXPECT_NE(textOf(rows).find(whatToDo(StopCause(cause))), std::string::npos) << textOf(rows);
        }
    topics::Device fault = deviceIn(SafetyState::kFault, StopCause::kDeviceFault);
    fault.set_fault_code(17);
    EXPECT_EQ(deviceRows(fault, nullptr)[1].value, "device fault 17");
}

TEST(DeviceLines, BeforeItEngagesItIsAWarningAndACauseThatIsOverIsNotShown) {
    for (const SafetyState state :
         {SafetyState::kConnected, SafetyState::kHoming, SafetyState::kReady, SafetyState::kPaused}) {
        const auto rows = deviceRows(deviceIn(state, StopCause::kSpeed), nullptr);
        ASSERT_EQ(rows.size(), 1u);
        EXPECT_EQ(rows[0].tone, HudTone::kWarning);
    }
}

TEST(DeviceLines, ReadyAndPausedSayWhatTheyWaitFor) {
    for (const SafetyState state : {SafetyState::kReady, SafetyState::kPaused}) {
        const std::string name = nameOf(state);
        topics::Device waits = deviceIn(state);
        waits.set_force_waits(true);
        EXPECT_EQ(textOf(deviceRows(waits, nullptr)), name + " move the tool away");
        waits.set_force_waits(false);
        waits.set_abilities(kAbilityEnablingSwitch);
        EXPECT_EQ(textOf(deviceRows(waits, nullptr)), name + " hold the enabling switch");
        waits.set_is_enabled(true);
        const std::string anew = state == SafetyState::kPaused ? " press the switch anew" : "";
        EXPECT_EQ(textOf(deviceRows(waits, nullptr)), name + anew);
    }
}

TEST(DeviceLines, TheToolsStateIsNewerAndUnknownStatesAreAlarms) {
    topics::ToolState tool;
    tool.set_device_state(uint32_t(SafetyState::kEmergencyStop));
    tool.set_stop_cause(uint32_t(StopCause::kEmergencyStop));
    const auto rows = deviceRows(deviceIn(SafetyState::kEngaged), &tool);
    EXPECT_EQ(rows[0].value, "emergency stop");
    EXPECT_EQ(textOf(rows), std::string("emergency stop ") + whatToDo(StopCause::kEmergencyStop));
    tool.set_device_state(1000);
    EXPECT_EQ(deviceRows(deviceIn(SafetyState::kEngaged), &tool)[0].tone, HudTone::kAlarm);
}

TEST(DeviceLines, AreThereOnlyWhereAServerTellsOfADevice) {
    HudInput input;
    input.status.emplace();
    input.show_details = true;
    const size_t without = makeHud(input).details.size();
    *input.status->mutable_device() = deviceIn(SafetyState::kEngaged);
    EXPECT_EQ(makeHud(input).details.size(), without + 1);
}

}  // namespace
}  // namespace bonemill

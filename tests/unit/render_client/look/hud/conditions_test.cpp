#include "render_client/look/hud/conditions.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/device_messages/device_messages.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "tests/support/hud_rows.h"

namespace bonemill {
namespace {

HudInput runningSession() {
    HudInput input;
    input.connection = Connection::kLive;
    input.status.emplace().set_ticks(1000);
    return input;
}
const Condition* findCondition(const std::vector<Condition>& conditions, const std::string& id) {
    const auto found = std::ranges::find(conditions, id, &Condition::id);
    return found == conditions.end() ? nullptr : &*found;
}

TEST(Conditions, AGoodSessionHasNone) {
    EXPECT_TRUE(conditionsOf({}).empty());
    EXPECT_TRUE(conditionsOf(runningSession()).empty());
}

TEST(Conditions, AnOrderlyEndIsNoFaultAndNotRed) {
    HudInput input = runningSession();
    input.status->set_device_stale(true);  // the last that was heard: the device had left first
    input.connection = Connection::kServerEnded;
    const auto conditions = conditionsOf(input);
    ASSERT_EQ(conditions.size(), 1u);
    EXPECT_EQ(conditions[0].tone, HudTone::kPlain);
    EXPECT_FALSE(conditions[0].is_fault);
    EXPECT_NE(conditions[0].text.find("has ended"), std::string::npos);
    EXPECT_EQ(makeHud(input).state, "ended");
    EXPECT_EQ(makeHud(input).state_tone, HudTone::kPlain);
}

TEST(Conditions, WhoMillsInAPauseIsToldWhatGoesOn) {
    HudInput input = runningSession();
    input.status->set_is_milling_paused(true);
    input.tool.emplace();
    EXPECT_TRUE(conditionsOf(input).empty()) << "the figures say it";
    input.tool->set_buttons(kButtonRemove);
    const auto conditions = conditionsOf(input);
    ASSERT_EQ(conditions.size(), 1u);
    EXPECT_NE(conditions[0].text.find("Press P to go on"), std::string::npos);
    EXPECT_FALSE(conditions[0].is_fault);
    input.status->set_is_milling_paused(false);
    EXPECT_TRUE(conditionsOf(input).empty());
}

TEST(Conditions, WhoHoldsThePedalWhileBoneIsPutBackIsToldToReleaseIt) {
    HudInput input = runningSession();
    input.tool.emplace().set_waits_for_release(true);
    EXPECT_TRUE(conditionsOf(input).empty()) << "nobody asks for anything";
    input.tool->set_buttons(kButtonRemove);
    const auto conditions = conditionsOf(input);
    ASSERT_EQ(conditions.size(), 1u);
    EXPECT_NE(conditions[0].text.find("Release the pedal"), std::string::npos);
    EXPECT_FALSE(conditions[0].is_fault);
    const Hud hud = makeHud(input);
    const HudRow* const burr = test::findRow(hud.rows, "Burr");
    ASSERT_TRUE(burr);
    EXPECT_EQ(burr->value, "release the pedal");
    input.tool->set_waits_for_release(false);
    EXPECT_TRUE(conditionsOf(input).empty());
}

TEST(Conditions, AServerThatFallsSilentIsAFault) {
    HudInput input = runningSession();
    input.connection = Connection::kServerLost;
    const auto conditions = conditionsOf(input);
    ASSERT_EQ(conditions.size(), 1u);
    EXPECT_EQ(conditions[0].tone, HudTone::kAlarm);
    EXPECT_TRUE(conditions[0].is_fault && conditions[0].lasts);
}

TEST(Conditions, TheDevicesSilenceLastsUntilItSpeaksAgain) {
    HudInput input = runningSession();
    input.status->set_device_stale(true);
    input.status->set_faults(kFaultStaleDevice);
    input.status->set_fault_text(faultNames(kFaultStaleDevice));
    auto conditions = conditionsOf(input);
    ASSERT_EQ(conditions.size(), 1u) << "latched and lasting are the same fault";
    EXPECT_TRUE(conditions[0].lasts);
    const std::string id = conditions[0].id;
    input.status->set_device_stale(false);
    conditions = conditionsOf(input);
    ASSERT_EQ(conditions.size(), 1u);
    EXPECT_EQ(conditions[0].id, id);
    EXPECT_FALSE(conditions[0].lasts);
    input.status->set_ticks(0);
    input.status->set_faults(0);
    input.status->set_device_stale(true);
    EXPECT_TRUE(conditionsOf(input).empty()) << "there was no device yet";
}

TEST(Conditions, AStopIsAFaultAndAWaitIsNone) {
    HudInput input = runningSession();
    topics::Device& device = *input.status->mutable_device();
    device.set_state(uint32_t(SafetyState::kProtectiveStop));
    device.set_stop_cause(uint32_t(StopCause::kSpeed));
    auto conditions = conditionsOf(input);
    ASSERT_TRUE(findCondition(conditions, "stop"));
    EXPECT_TRUE(findCondition(conditions, "stop")->is_fault);
    device.set_state(uint32_t(SafetyState::kReady));
    device.set_force_waits(true);
    conditions = conditionsOf(input);
    EXPECT_FALSE(findCondition(conditions, "stop"));
    ASSERT_TRUE(findCondition(conditions, "wait"));
    EXPECT_FALSE(findCondition(conditions, "wait")->is_fault);
    EXPECT_EQ(makeHud(input).state_tone, HudTone::kWarning)
        << "live is only as good as what stands in its way";
    device.set_state(uint32_t(SafetyState::kProtectiveStop));
    EXPECT_EQ(makeHud(input).state_tone, HudTone::kAlarm);
}

TEST(Conditions, TheEndOfAScriptIsNoFault) {
    HudInput input = runningSession();
    input.status->mutable_device()->set_state(uint32_t(SafetyState::kEngaged));
    EXPECT_TRUE(conditionsOf(input).empty());
    input.status->mutable_device()->mutable_script()->set_has_ended(true);
    const auto conditions = conditionsOf(input);
    ASSERT_EQ(conditions.size(), 1u);
    EXPECT_FALSE(conditions[0].is_fault);
    EXPECT_EQ(conditions[0].tone, HudTone::kPlain);
}

TEST(Conditions, AHandThatMakesWayWaitsForNothing) {
    HudInput input = runningSession();
    topics::Device& device = *input.status->mutable_device();
    device.set_state(uint32_t(SafetyState::kPaused));
    device.set_abilities(kAbilityEnablingSwitch);
    EXPECT_TRUE(findCondition(conditionsOf(input), "wait"));
    device.mutable_script()->set_taken_over_by(7);
    EXPECT_FALSE(findCondition(conditionsOf(input), "wait"));
}

TEST(FaultWords, EveryFaultOfTheServerHasWords) {
    std::string all;
    for (uint32_t fault = 1; fault <= kLastFault; fault <<= 1) {
        const auto words = faultWords(faultNames(fault));
        ASSERT_EQ(words.size(), 1u);
        EXPECT_EQ(words[0].text.find(words[0].id), std::string::npos) << words[0].text;
        EXPECT_EQ(words[0].text.find('_'), std::string::npos) << words[0].text;
    }
    // A tick without time and contact points without time are one message.
    EXPECT_EQ(faultWords(faultNames(2 * kLastFault - 1)).size(), faultList(2 * kLastFault - 1).size() - 1);
    EXPECT_EQ(faultWords("contact_overflow")[0].text, faultWords("overrun")[0].text);
}

TEST(FaultWords, ANameOfALaterVersionIsPassedOnOnce) {
    const auto words = faultWords("quake, quake,, overrun");
    ASSERT_EQ(words.size(), 2u);
    EXPECT_EQ(words[0].text, "The server reports: quake.");
}

}  // namespace
}  // namespace bonemill

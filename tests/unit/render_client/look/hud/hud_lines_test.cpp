#include "render_client/look/hud/hud_lines.h"

#include <gtest/gtest.h>

#include <limits>

#include "render_client/look/hud/device_lines.h"
#include "tests/support/hud_rows.h"

namespace bonemill {
namespace {

const HudRow* find(const Hud& hud, const std::string& label) {
    const HudRow* const row = test::findRow(hud.rows, label);
    return row ? row : test::findRow(hud.details, label);
}

// Stays valid until the next call.
const Hud& hudOf(const HudInput& input) {
    static Hud hud;
    return hud = makeHud(input);
}

HudInput liveInput() {
    HudInput input;
    topics::SceneInfo info;
    info.set_name("skull");
    input.info = info;
    topics::Status status;
    status.set_preset("thesis_2012");
    status.set_ticks(1000);
    status.set_rate_hz(999.84);
    status.set_tick_p50_us(92.04);
    status.set_tick_p99_us(187.42);
    status.set_removed_mm3(12.345);
    status.set_node_count(40);
    input.status = status;
    topics::ToolState tool;
    for (const double v : {3.0, 0.0, 4.0}) tool.add_force_n(v);
    for (const double v : {0.0, 0.012, 0.0}) tool.add_torque_nm(v);
    tool.set_contacts(17);
    tool.set_buttons(1);
    input.tool = tool;
    input.connection = Connection::kLive;
    input.node_count = 40;
    input.show_details = true;
    return input;
}

TEST(Hud, ShowsWhatTheServerMeasuresWithUnits) {
    const Hud hud = makeHud(liveInput());
    EXPECT_EQ(hud.title, "skull");
    EXPECT_EQ(hud.state, "live, 0:00:00");
    EXPECT_EQ(hud.state_tone, HudTone::kGood);
    ASSERT_TRUE(find(hud, "Loop"));
    EXPECT_EQ(find(hud, "Loop")->value, "999.8 Hz");
    EXPECT_EQ(find(hud, "Tick p50 / p99")->value, "92.0 / 187.4 \u00b5s");
    EXPECT_EQ(find(hud, "Force")->value, "5.00 N");
    EXPECT_EQ(find(hud, "Torque")->value, "12.0 N\u00b7mm");
    EXPECT_EQ(find(hud, "Contacts")->value, "17");
    EXPECT_EQ(find(hud, "Burr")->value, "removing");
    EXPECT_EQ(find(hud, "Removed")->value, "12.3 mm\u00b3");
    EXPECT_EQ(find(hud, "Accuracy")->value, "thesis_2012");
    EXPECT_EQ(find(hud, "Faults")->value, "none");
}

TEST(Hud, InTheAirTheBurrOnlyTurns) {
    HudInput input = liveInput();
    input.tool->set_contacts(0);
    EXPECT_EQ(find(makeHud(input), "Burr")->value, "removing") << "the scene does not say what is removed";
    input.tool->mutable_effects();
    EXPECT_EQ(find(makeHud(input), "Burr")->value, "turning");
    input.tool->mutable_effects()->set_removed_mm3(0.01);
    EXPECT_EQ(find(makeHud(input), "Burr")->value, "removing") << "it removes faster than it is led";
    input.tool->set_buttons(0);
    EXPECT_EQ(find(makeHud(input), "Burr")->value, "idle");
}

TEST(Hud, TheBurrsLoadIsItsForceUpToTwoNewtons) {
    topics::ToolState tool;
    EXPECT_EQ(burrLoadOf(tool), 0);
    for (const double part : {0.6, 0.0, 0.8}) tool.add_force_n(part);
    EXPECT_DOUBLE_EQ(burrLoadOf(tool), 0.5);
    tool.mutable_effects()->set_burr_force_n(7);
    EXPECT_EQ(burrLoadOf(tool), 1);
}

TEST(Hud, MoreThanWasThereIsCalledAdded) {
    HudInput input = liveInput();
    input.status->set_removed_mm3(-12.345);
    EXPECT_EQ(find(makeHud(input), "Added")->value, "12.3 mm\u00b3");
    EXPECT_FALSE(find(makeHud(input), "Removed"));
}

TEST(Hud, SaysHowTheOtherAttemptStands) {
    HudInput input = liveInput();
    topics::Comparison& comparison = *input.status->mutable_replay()->mutable_comparison();
    comparison.set_attempt_s(75);
    EXPECT_EQ(find(makeHud(input), "Other")->value, "0:01:15");
    comparison.set_is_on_its_way(true);
    EXPECT_EQ(find(makeHud(input), "Other")->value, "on its way");
    comparison.set_problem("b.mcap: is of another scene");
    EXPECT_EQ(find(makeHud(input), "Other")->tone, HudTone::kWarning);
}

TEST(Hud, OnlyWhatMattersToTheTaskIsThereUntilTheRestIsAskedFor) {
    HudInput input = liveInput();
    input.tool->mutable_effects()->set_spin_speed(1);
    input.tool->mutable_effects()->set_temperature_c(37);
    input.show_details = false;
    const Hud quiet = makeHud(input);
    EXPECT_TRUE(quiet.details.empty());
    std::vector<std::string> labels;
    for (const HudRow& row : quiet.rows) labels.push_back(row.label);
    EXPECT_EQ(labels, (std::vector<std::string>{"Force", "Burr", "Removed", "Hottest bone"}));
    input.show_details = true;
    EXPECT_EQ(makeHud(input).rows.size(), quiet.rows.size()) << "the rest stands below";
    EXPECT_TRUE(test::findRow(makeHud(input).details, "Spindle"));
}

// No state of a session may move the figures that the trainee reads.
TEST(Hud, TheTasksFiguresHaveTheSameLinesInEveryState) {
    HudInput input = liveInput();
    const size_t lines = makeHud(input).rows.size();
    input.status->set_is_milling_paused(true);
    input.status->set_faults(0xff);
    input.status->set_fault_text("overrun, stale_device, solve");
    input.status->set_device_stale(true);
    input.status->set_preset(std::string(200, 'x') + " y z");
    input.status->mutable_device()->set_state(6);
    input.connection = Connection::kServerLost;
    input.events = 0x1f;
    EXPECT_EQ(makeHud(input).rows.size(), lines);
}

TEST(Hud, TheBurrSaysWhatKeepsItFromMilling) {
    HudInput input = liveInput();
    input.status->set_is_milling_paused(true);
    EXPECT_EQ(find(hudOf(input), "Burr")->value, "paused");
    EXPECT_EQ(find(hudOf(input), "Burr")->tone, HudTone::kWarning);
    input.events = topics::EffectState::SPINDLE_STALLED;
    EXPECT_EQ(find(hudOf(input), "Burr")->value, "stalled");
    EXPECT_EQ(find(hudOf(input), "Burr")->tone, HudTone::kAlarm);
}

TEST(Hud, CountsTheFaultsOfTheSession) {
    HudInput input = liveInput();
    input.fault_count = 2;
    const Hud hud = makeHud(input);
    EXPECT_EQ(find(hud, "Faults")->value, "2, see the panel");
    EXPECT_EQ(find(hud, "Faults")->tone, HudTone::kWarning);
}

TEST(Hud, SaysHowItStandsWithTheServer) {
    HudInput input;
    EXPECT_EQ(makeHud(input).state, "waiting for a server");
    EXPECT_TRUE(makeHud(input).rows.empty());
    input = liveInput();
    input.connection = Connection::kReceiving;
    input.node_count = 32;
    EXPECT_EQ(makeHud(input).state, "loading 80 %");
    input.node_count = 220;
    EXPECT_EQ(makeHud(input).state, "loading 100 %") << "those of the scene before count as well";
    input.connection = Connection::kServerLost;
    EXPECT_EQ(makeHud(input).state, "server lost");
    EXPECT_EQ(makeHud(input).state_tone, HudTone::kAlarm);
}

TEST(Hud, TheScenesTitleGoesBeforeItsName) {
    HudInput input = liveInput();
    const std::string name = makeHud(input).title;
    input.info->set_title("Straight bore, molar");
    EXPECT_EQ(makeHud(input).title, "Straight bore, molar");
    EXPECT_NE(name, "Straight bore, molar");
    input.modes = {"Cut Y on (Y: off)"};
    EXPECT_EQ(makeHud(input).modes.size(), 1u);
    input.is_in_eyes = true;
    EXPECT_TRUE(makeHud(input).modes.empty());
}

TEST(Hud, ALoopThatNeverTickedHasNoNumbers) {
    HudInput input = liveInput();
    input.status->set_ticks(0);
    const Hud hud = makeHud(input);
    EXPECT_EQ(hud.state, "waits for a device");
    EXPECT_EQ(hud.state_tone, HudTone::kWarning);
    EXPECT_EQ(find(hud, "Loop")->value, "\u2013");
    EXPECT_EQ(find(hud, "Tick p50 / p99")->value, "\u2013");
    EXPECT_EQ(find(hudOf(input), "Accuracy")->value, "thesis_2012");
}

TEST(Hud, TheForceErrorIsTheServersOrNotMeasured) {
    HudInput input = liveInput();
    input.status->set_preset("balanced");
    input.status->set_force_error_percent(0.8);
    input.status->set_force_direction_error_deg(0.4);
    EXPECT_EQ(find(hudOf(input), "Force error")->value, "not measured") << "figures that the server disowns";
    input.status->set_has_accuracy_error(true);
    EXPECT_EQ(find(hudOf(input), "Accuracy")->value, "balanced");
    EXPECT_EQ(find(hudOf(input), "Force error")->value, "0.80 %, 0.40\u00b0");
    input.status->set_force_error_percent(123.4);
    input.status->set_force_direction_error_deg(12.34);
    EXPECT_EQ(find(hudOf(input), "Force error")->value, "123.4 %, 12.3\u00b0");
}

TEST(Hud, LongSettingsTakeMoreThanOneLine) {
    HudInput input = liveInput();
    input.status->set_preset("gradient s=2 q=2 grid x1 float iterations=3 ccd");
    const Hud hud = makeHud(input);
    const HudRow* first = find(hud, "Accuracy");
    ASSERT_TRUE(first);
    EXPECT_EQ(first->value, "gradient s=2 q=2 grid x1");
    EXPECT_EQ(first[1].label, "");
    EXPECT_EQ(first[1].value, "float iterations=3 ccd");
    EXPECT_EQ(first[2].label, "Force error");
}

TEST(Hud, TheSessionsClock) {
    HudInput input = liveInput();
    input.status->set_session_s(3725.9);
    EXPECT_EQ(makeHud(input).state, "live, 1:02:05");
    input.status->set_session_s(std::numeric_limits<double>::quiet_NaN());
    EXPECT_EQ(makeHud(input).state, "live, \u2013");
}

TEST(Hud, AllKnobsAreAtMostTwoLines) {
    HudInput input = liveInput();
    std::string knobs;
    for (int i = 0; i < 30; ++i) knobs += "knob=17 ";
    input.status->set_preset(knobs);
    const Hud hud = makeHud(input);
    EXPECT_EQ(find(hud, "Force error") - find(hud, "Accuracy"), 2);
}

TEST(Hud, TheToolsNameWhenThereIsAChoice) {
    HudInput input = liveInput();
    input.info->add_tool_names("round burr 4 mm");
    EXPECT_FALSE(find(hudOf(input), "Tool"));
    input.info->add_tool_names("round burr 2 mm");
    input.info->set_tool_index(1);
    EXPECT_EQ(find(hudOf(input), "Tool")->value, "round burr 2 mm");
    input.info->set_tool_index(7);
    EXPECT_FALSE(find(hudOf(input), "Tool"));
}

TEST(Hud, TheViewersOwnFrameRate) {
    HudInput input = liveInput();
    EXPECT_FALSE(find(hudOf(input), "Pictures"));
    input.frame_rate_hz = 59.7;
    EXPECT_EQ(find(hudOf(input), "Pictures")->value, "60 Hz");
}

topics::Viewer watcher(const std::string& name) {
    topics::Viewer viewer;
    viewer.set_name(name);
    viewer.set_frame_rate_hz(29.9);
    viewer.set_is_complete(true);
    return viewer;
}

TEST(Hud, WhoIsWatching) {
    HudInput input = liveInput();
    EXPECT_TRUE(makeHud(input).watchers.empty());
    input.show_details = false;
    input.show_watchers = true;
    input.watchers = {watcher("Anna"), watcher(""), watcher("Dr. Berg")};
    input.watchers[1].set_role(topics::Viewer::OPERATOR);
    input.watchers[1].set_is_complete(false);
    input.watchers[2].set_is_holding(true);
    input.watchers[2].set_role(topics::Viewer::INSTRUCTOR);
    const std::vector<HudRow> rows = makeHud(input).watchers;
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].label, "Anna");
    EXPECT_EQ(rows[0].value, "viewer, 30 Hz");
    EXPECT_EQ(rows[1].label, "(no name)");
    EXPECT_EQ(rows[1].value, "operator, 30 Hz, incomplete");
    EXPECT_EQ(rows[1].tone, HudTone::kWarning);
    EXPECT_EQ(rows[2].value, "instructor, 30 Hz, holds the tool");
    input.show_details = true;
    EXPECT_EQ(find(hudOf(input), "Watching")->value, "3");
    EXPECT_TRUE(makeHud(input).watchers.empty()) << "one list at a time";
}

TEST(Hud, ALongListOfWatchersIsCut) {
    HudInput input = liveInput();
    input.show_details = false;
    input.show_watchers = true;
    for (int i = 0; i < 6; ++i) input.watchers.push_back(watcher("w" + std::to_string(i)));
    EXPECT_EQ(makeHud(input).watchers.size(), 6u);
    EXPECT_EQ(makeHud(input).watchers.back().label, "w5");
    for (int i = 6; i < 30; ++i) input.watchers.push_back(watcher("w" + std::to_string(i)));
    const std::vector<HudRow> rows = makeHud(input).watchers;
    ASSERT_EQ(rows.size(), 6u);
    EXPECT_EQ(rows[4].label, "w4");
    EXPECT_EQ(rows[5].label, "and 25 more");
}

TEST(Hud, ALongNameIsCutBetweenLetters) {
    HudInput input = liveInput();
    std::string name;
    for (int i = 0; i < 40; ++i) name += "\u00e4";
    input.watchers = {watcher(name)};
    input.show_details = false;
    input.show_watchers = true;
    std::string expected;
    for (int i = 0; i < 23; ++i) expected += "\u00e4";
    EXPECT_EQ(makeHud(input).watchers[0].label, expected + "\u2026");
}

TEST(Hud, ANoticeIsPassedOn) {
    HudInput input = liveInput();
    EXPECT_FALSE(makeHud(input).notice);
    input.notice = HudNotice{"accuracy fast: done", HudTone::kGood};
    ASSERT_TRUE(makeHud(input).notice);
    EXPECT_EQ(makeHud(input).notice->text, "accuracy fast: done");
    EXPECT_EQ(makeHud(input).notice->tone, HudTone::kGood);
}

TEST(Hud, AHintGivesWayToTheHelpPage) {
    HudInput input;
    EXPECT_FALSE(makeHud(input).hint);
    input.hint = HudHint{{{"Wheel", "deeper"}}, 0.5f};
    ASSERT_TRUE(makeHud(input).hint);
    EXPECT_EQ(makeHud(input).hint->opacity, 0.5f);
    for (bool* const asked : {&input.show_help, &input.show_details, &input.show_watchers}) {
        *asked = true;
        EXPECT_FALSE(makeHud(input).hint) << "who has found the keys needs none";
        *asked = false;
    }
}

TEST(Hud, TheHelpPageIsShownOnRequest) {
    HudInput input;
    input.help = {{"Screen", {{"H", "help"}}}};
    EXPECT_TRUE(makeHud(input).help.empty());
    input.show_help = true;
    ASSERT_EQ(makeHud(input).help.size(), 1u);
    EXPECT_EQ(makeHud(input).help[0].rows[0].label, "H");
}

TEST(Hud, ALockSaysWhoCanJoin) {
    HudInput input;
    EXPECT_EQ(makeHud(input).lock, HudLock::kNone);
    input.sought = ServerSought{};
    input.sought->lock = HudLock::kOpen;
    EXPECT_EQ(makeHud(input).lock, HudLock::kOpen);
}

TEST(Hud, WaitingNamesTheServerAndWhatToTry) {
    HudInput input;
    input.sought = ServerSought{7, 3, "one-pc", "", false, false};
    const HudPage page = makeHud(input).page.value();
    EXPECT_EQ(test::findRow(page.rows, "Session")->value, "7");
    EXPECT_EQ(test::findRow(page.rows, "Domain")->value, "3");
    EXPECT_EQ(test::findRow(page.rows, "Profile")->value, "one-pc");
    EXPECT_FALSE(test::findRow(page.rows, "Interface"));
    EXPECT_GE(page.lines.size(), 2u);
    EXPECT_TRUE(makeHud(input).title.empty()) << "there are no figures yet";
    input.sought->is_on_lan = true;
    input.sought->interface = "eth7";
    EXPECT_EQ(test::findRow(makeHud(input).page->rows, "Interface")->value, "eth7");
    EXPECT_NE(makeHud(input).page->lines.back().find("check-network"), std::string::npos);
    for (const Connection connection : {Connection::kReceiving, Connection::kLive, Connection::kServerLost}) {
        input.connection = connection;
        EXPECT_FALSE(makeHud(input).page);
        EXPECT_FALSE(makeHud(input).title.empty());
    }
}

TEST(Hud, EachEyeSeesOnlyWhatMustNotBeOverseen) {
    HudInput input = liveInput();
    input.is_in_eyes = true;
    input.watchers = {watcher("Anna")};
    input.hint = HudHint{{{"Wheel", "deeper"}}, 1};
    input.notice = HudNotice{"accuracy fast: done", HudTone::kGood};
    input.messages = {{"The device sends nothing.", HudTone::kAlarm}};
    input.events = topics::EffectState::TOO_HOT;
    Hud hud = makeHud(input);
    EXPECT_TRUE(hud.title.empty() && hud.rows.empty() && hud.details.empty() && !hud.hint);
    EXPECT_TRUE(hud.notice && hud.alert);
    EXPECT_EQ(hud.messages.size(), 1u);
    input.show_details = false;
    input.show_watchers = true;
    EXPECT_TRUE(makeHud(input).watchers.empty());
    input.show_help = true;
    input.help = {{"Screen", {{"H", "help"}}}};
    EXPECT_FALSE(makeHud(input).help.empty()) << "it was asked for";
}

TEST(Hud, NumbersThatAreNoneBecomeADash) {
    HudInput input = liveInput();
    input.status->set_rate_hz(std::numeric_limits<double>::quiet_NaN());
    input.tool->clear_force_n();
    const Hud hud = makeHud(input);
    EXPECT_EQ(find(hud, "Loop")->value, "\u2013");
    EXPECT_EQ(find(hud, "Force")->value, "\u2013");
}

}  // namespace
}  // namespace bonemill

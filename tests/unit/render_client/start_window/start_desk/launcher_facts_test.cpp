#include "render_client/start_window/start_desk/launcher_facts.h"

#include <gtest/gtest.h>

#include "render_client/start_window/start_desk/launcher_words.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using Words = std::vector<std::string>;

TEST(LauncherFacts, AListTellsScenesSessionsRecordingsAndInterfaces) {
    const std::string file = test::sourceDir() + "/deploy/scenes/tooth_corridor.textproto";
    const ListFacts facts =
        listFactsOf("scene\ttooth_corridor\t" + file +
                    "\t/a.png\ttooth jaw\t/b.nrrd\ncase\tmine\t/nowhere.textproto\t\t\t\n"
                    "session\t2\tskull\tauto\t12:00:01\nrecording\t/r.mcap\t2026-01-02 03:04\t7\n"
                    "interface\teth0\nscene\tshort\nunknown\tline\n\n");
    ASSERT_EQ(facts.scenes.size(), 2u);
    const SceneCard& shipped = facts.scenes[0];
    EXPECT_EQ(shipped.title, "Straight bore, molar");
    EXPECT_EQ(shipped.task, "Bore straight down a cusp to the middle of the tooth.");
    EXPECT_EQ(shipped.expected_minutes, 5);
    EXPECT_EQ(shipped.made_first, (Words{"tooth", "jaw"}));
    EXPECT_EQ(shipped.lacks, "/b.nrrd");
    EXPECT_EQ(shipped.problem, "");
    EXPECT_TRUE(facts.scenes[1].is_own);
    EXPECT_EQ(facts.scenes[1].title, "mine");
    EXPECT_NE(facts.scenes[1].problem.find("/nowhere.textproto"), std::string::npos);
    ASSERT_EQ(facts.running.size(), 1u);
    EXPECT_EQ(facts.running[0].scene, "skull");
    ASSERT_EQ(facts.recordings.size(), 1u);
    EXPECT_EQ(facts.recordings[0].when, "2026-01-02 03:04");
    EXPECT_EQ(facts.interfaces, Words{"eth0"});
}

TEST(LauncherFacts, TheDoctorTellsWhatIsMissingAndWhichHandIsBest) {
    const DoctorFacts facts = doctorFactsOf(
        "Real time\tok\tlocked memory\nNetwork\tMISSING\tlink: no cable\tplug it in\tand on\n"
        "hand\tTouch\tnot ready\tyou may not write to it\tsudo cp rules\n"
        "hand\tgamepad\tready\tPad\tbonemill start --device gamepad:/dev/input/event3\n"
        "hand\tpedal or keys\tready\tKeys\tbonemill start --pedal /dev/input/event4\nhand\tshort\n");
    ASSERT_EQ(facts.findings.size(), 2u);
    EXPECT_TRUE(facts.findings[0].is_ok);
    EXPECT_TRUE(facts.findings[1].is_needed);
    EXPECT_EQ(facts.findings[1].commands, (Words{"plug it in", "and on"}));
    ASSERT_EQ(facts.hands.size(), 3u);
    EXPECT_EQ(facts.hands[0].word, "");
    EXPECT_EQ(facts.hands[0].command, "sudo cp rules");
    EXPECT_EQ(facts.hands[1].word, "gamepad:/dev/input/event3");
    EXPECT_EQ(facts.hands[2].word, "") << "a pedal is no hand";
}

TEST(LauncherFacts, SessionsOfOtherPCsAreFound) {
    const std::vector<FoundSession> found =
        foundSessionsOf("3\tskull\t14:05:09\tlab-pc-2\tlab\teth0\nhalf\ta line\n");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(watchWords(found[0], {"--domain", "4"}),
              (Words{"watch", "--session", "3", "--domain", "4", "--profile", "lab", "--interface", "eth0"}));
}

TEST(LauncherWords, AreThoseThatSomebodyWouldType) {
    SceneCard card;
    card.name = "skull";
    card.file = "/home/me/my cases/skull.textproto";
    EXPECT_EQ(startWords(card, {}, {}), (Words{"start", "skull"}));
    EXPECT_EQ(startWords(card, {.device = "simulated"}, {"--domain", "4"}),
              (Words{"start", "skull", "--domain", "4", "--device", "simulated"}));
    const StartChoice choice{.is_class = true, .interface = "eth0", .class_name = "Group 3"};
    EXPECT_EQ(startWords(card, choice, {}),
              (Words{"host", "skull", "--interface", "eth0", "--class", "Group 3"}));
    EXPECT_EQ(startWords(card, choice, {"--interface", "eth1"}),
              (Words{"host", "skull", "--interface", "eth1", "--class", "Group 3"}))
        << "what was said at the start holds";
    card.is_own = true;
    EXPECT_EQ(commandLineOf(startWords(card, {}, {})), "bonemill start '/home/me/my cases/skull.textproto'");
}

}  // namespace
}  // namespace bonemill

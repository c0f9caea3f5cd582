#include "render_client/start_window/start_screen/start_screen.h"

#include <gtest/gtest.h>

#include "tests/unit/render_client/start_window/start_desk/fake_launcher.h"
#include "tests/unit/render_client/start_window/start_screen/clicked_start.h"

namespace bonemill {
namespace {

constexpr int kWidth = 1280, kHeight = 800;
constexpr char kDoctor[] =
    "Real time\tok\tlocked memory\nNetwork\tbetter\tpackets: they are cut\tsudo ip link set eth0 mtu 1500\n"
    "hand\tgamepad\tready\tPad\tbonemill start --device gamepad:/dev/input/event3\n"
    "hand\tmouse\tready\tin a viewer's window\tbonemill start --device pointer\n";

class StartScreenTest : public testing::Test {
  protected:
    StartScreenTest() {
        launcher_.put("doctor", kDoctor);
        launcher_.put("sessions", "/c/a.json\t/r.mcap\t2026-01-02 03:04\tSkull\tAnn\tscore 80 of 100\n");
        launcher_.put("found", "3\tskull\t14:05:09\tlab-pc-2\tlab\teth0\n");
    }
    test::ClickedStart& show(int width = kWidth, int height = kHeight, float desktop_scale = 1) {
        start_.emplace(launcher_.file(), width, height, desktop_scale);
        // Its line moves those below it, which a click would miss.
        start_->await([&] { return !start_->desk.found().empty(); });
        return *start_;
    }
    // Takes the words that bonemill was told last, and lets what it began come to its end.
    std::string toldNow() {
        start_->await([&] { return start_->desk.hasWindowOfItsOwn(); });
        launcher_.letEnd();
        start_->await([&] { return !start_->desk.isBusy(); });
        const std::string told = launcher_.told();
        launcher_.put("told", "");
        return told;
    }
    // Three scenes in two columns, the shortest first.
    void listThree() {
        std::string lines;
        for (const char* name : {"tooth_corridor", "pedicle", "minimal"})
            lines += std::string("scene\t") + name + "\t" + test::sourceDir() + "/deploy/scenes/" + name +
                     ".textproto\t\t\t\n";
        launcher_.put("list",
                      lines + "session\t2\tskull\tauto\t12:00:01\ninterface\teth0\ninterface\teth1\n");
    }

    test::FakeLauncher launcher_;
    std::optional<test::ClickedStart> start_;
};

TEST_F(StartScreenTest, EveryCardStartsItsScene) {
    test::ClickedStart& start = show();
    const std::vector<SceneCard> cards = start.desk.list().scenes;
    EXPECT_GE(cards.size(), 10u) << "all that deploy/scenes has";
    for (const SceneCard& card : cards) {
        EXPECT_EQ(card.problem, "") << card.name;
        EXPECT_NE(card.task, "") << card.name;
        EXPECT_GT(card.expected_minutes, 0) << card.name;
        start.click(card.name);
        EXPECT_EQ(toldNow(), "start " + card.name + "\n");
    }
}

TEST_F(StartScreenTest, ArrowsGoFromCardToCardAndEnterStarts) {
    listThree();
    test::ClickedStart& start = show();
    start.hit(Key::kRight);  // from the first, minimal, to the second
    start.hit(Key::kEnter);
    EXPECT_EQ(toldNow(), "start tooth_corridor\n");
    start.hit(Key::kDown);
    start.hit(Key::kEnter);
    EXPECT_EQ(toldNow(), "start pedicle\n");
}

TEST_F(StartScreenTest, TheHandIsAChoice) {
    listThree();
    test::ClickedStart& start = show();
    start.click("gamepad: Pad");
    start.click("minimal");
    EXPECT_EQ(toldNow(), "start minimal --device gamepad:/dev/input/event3\n");
    start.click("Mouse");
    start.click("minimal");
    EXPECT_EQ(toldNow(), "start minimal --device pointer\n");
    start.click("The best that is there");
    start.click("minimal");
    EXPECT_EQ(toldNow(), "start minimal\n");
}

TEST_F(StartScreenTest, AClassIsHostedOnTheChosenInterface) {
    listThree();
    test::ClickedStart& start = show();
    start.click("Host a class");
    start.click("eth1");
    start.click("##class");
    start.type("Group 3");
    start.click("pedicle");
    EXPECT_EQ(toldNow(), "host pedicle --interface eth1 --class Group 3\n");
}

TEST_F(StartScreenTest, SessionsAreWatchedAndReplayed) {
    listThree();
    test::ClickedStart& start = show();
    start.await([&] { return !start.desk.found().empty() && !start.desk.attempts().empty(); });
    start.click("Watch lab-pc-2 3");
    EXPECT_EQ(toldNow(), "watch --session 3 --profile lab --interface eth0\n");
    start.click("Watch 2");
    EXPECT_EQ(toldNow(), "watch --session 2\n");
    start.click("Replay 1");
    EXPECT_EQ(toldNow(), "replay /c/a.json\n");
    start.click("##host");
    start.type("192.0.2.7");
    start.hit(Key::kEnter);
    EXPECT_EQ(toldNow(), "watch 192.0.2.7\n");
}

TEST_F(StartScreenTest, WhatThisPcLacksIsCopiedAsACommand) {
    listThree();
    test::ClickedStart& start = show();
    std::string copied;
    start.screen.stage().useClipboard([] { return ""; }, [&](const std::string& text) { copied = text; });
    start.click("Network");
    start.click("Copy sudo ip link set eth0 mtu 1500");
    EXPECT_EQ(copied, "sudo ip link set eth0 mtu 1500");
}

TEST_F(StartScreenTest, AProblemIsOnTheScreen) {
    listThree();
    launcher_.put("fails", "bonemill: there is no scene 'minimal'\n");
    test::ClickedStart& start = show();
    EXPECT_FALSE(start.screen.find("problem"));
    start.click("minimal");
    start.await([&] { return !start.desk.isBusy(); });
    start.look();
    EXPECT_TRUE(start.screen.find("problem"));
}

// On a usual screen and on a dense one nothing has to be scrolled to.
TEST_F(StartScreenTest, AllFitsOnTheScreen) {
    struct Screen {
        int width, height;
        float desktop_scale;
    };
    for (const Screen& size : {Screen{1280, 800, 1}, {2560, 1600, 2}, {1920, 1080, 1}, {3840, 2160, 2}}) {
        test::ClickedStart& start = show(size.width, size.height, size.desktop_scale);
        start.await([&] { return !start.desk.found().empty() && !start.desk.attempts().empty(); });
        std::vector<std::string> labels{"Mouse",    "Host a class", "New case from a scan", "Handbook",
                                        "Replay 1", "Report 1",     "Watch lab-pc-2 3",     "##host",
                                        "Network",  "Hand"};
        for (const SceneCard& card : start.desk.list().scenes) labels.push_back(card.name);
        for (const std::string& label : labels)
            EXPECT_TRUE(start.screen.find(label)) << label << " at " << size.width << "x" << size.height;
    }
}

}  // namespace
}  // namespace bonemill

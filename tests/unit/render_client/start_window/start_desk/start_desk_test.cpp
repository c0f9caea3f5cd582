#include "render_client/start_window/start_desk/start_desk.h"

#include <gtest/gtest.h>

#include "tests/unit/render_client/start_window/start_desk/fake_launcher.h"

namespace bonemill {
namespace {

class StartDeskTest : public testing::Test {
  protected:
    StartDeskTest() { launcher_.put("list", "session\t2\tskull\tauto\t12:00:01\n"); }
    bool comesTo(const std::function<bool()>& condition) {
        return test::waitFor([&] {
            desk_.poll();
            return condition();
        });
    }
    static SceneCard scene(const std::string& name) {
        SceneCard card;
        card.name = name;
        return card;
    }

    test::FakeLauncher launcher_;
    StartDesk desk_{launcher_.file(), {"--domain", "4"}};
};

TEST_F(StartDeskTest, AsksBonemillForAllThatItKnows) {
    launcher_.put("doctor", "Real time\tok\tlocked memory\n");
    launcher_.put("found", "3\tskull\t14:05:09\tlab-pc-2\tlab\teth0\n");
    launcher_.put("sessions", "/c/r.json\t/r.mcap\t2026-01-02 03:04\tSkull\tAnn\tscore 80 of 100\n");
    EXPECT_TRUE(comesTo([&] { return desk_.hasList() && desk_.list().running.size() == 1; }));
    EXPECT_TRUE(comesTo([&] { return desk_.doctor() && desk_.doctor()->findings.size() == 1; }));
    EXPECT_TRUE(comesTo([&] { return desk_.attempts().size() == 1 && desk_.found().size() == 1; }));
    EXPECT_EQ(desk_.attempts()[0].trainee, "Ann");
}

TEST_F(StartDeskTest, ABonemillThatCannotListSaysWhy) {
    test::writeFile(launcher_.file(), "#!/bin/sh\necho 'bonemill: no folder of yours' >&2\nexit 2\n");
    EXPECT_TRUE(comesTo([&] { return desk_.problem() == "no folder of yours"; }));
}

TEST_F(StartDeskTest, GoesWhileASessionHasItsWindowAndComesBackAtItsEnd) {
    desk_.start(scene("skull"));
    EXPECT_TRUE(desk_.isBusy());
    EXPECT_TRUE(comesTo([&] { return desk_.hasWindowOfItsOwn(); }));
    EXPECT_EQ(desk_.lastWords(), "close the window or press Ctrl-C to end");
    desk_.start(scene("minimal"));  // there is one already
    launcher_.letEnd();
    EXPECT_TRUE(comesTo([&] { return !desk_.isBusy(); }));
    EXPECT_FALSE(desk_.hasWindowOfItsOwn());
    EXPECT_EQ(desk_.problem(), "");
    EXPECT_EQ(launcher_.told(), "start skull --domain 4\n");
}

TEST_F(StartDeskTest, WhatGoesWrongIsSaidInOneLine) {
    launcher_.put("fails", "bonemill: no PC called \033[2Jx is known here\nand more\n");
    desk_.watchHost("x");
    EXPECT_TRUE(comesTo([&] { return !desk_.isBusy(); }));
    EXPECT_EQ(desk_.problem(), "no PC called ?[2Jx is known here");
    EXPECT_EQ(launcher_.told(), "watch x --domain 4\n");
    std::filesystem::remove(launcher_.folder() / "fails");
    desk_.start(scene("skull"));
    EXPECT_EQ(desk_.problem(), "") << "it is over";
    desk_.askToEnd();
    EXPECT_TRUE(comesTo([&] { return !desk_.isBusy(); }));
    EXPECT_EQ(desk_.problem(), "bonemill was ended by signal 15");
}

TEST_F(StartDeskTest, ErrandsLeaveTheWindowWhereItIs) {
    launcher_.put("fails", "bonemill: the handbook is not on this PC\n");
    desk_.openHandbook();
    EXPECT_FALSE(desk_.isBusy());
    EXPECT_TRUE(comesTo([&] { return desk_.problem() == "the handbook is not on this PC"; }));
    desk_.endOwn({.number = "2", .scene = "skull", .device = "auto", .since = ""});
    EXPECT_TRUE(comesTo([&] { return launcher_.told() == "handbook\nstop 2\n"; }));
    desk_.makeCase();
    EXPECT_TRUE(comesTo([&] { return launcher_.told() == "handbook\nstop 2\nscan\n"; }));
}

}  // namespace
}  // namespace bonemill

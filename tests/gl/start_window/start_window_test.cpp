// bonemill without a word, from its window to milled bone, by the real programs.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <iostream>

#include "render_client/link/subscribe/scene_subscriber.h"
#include "tests/gl/start_window/start_rig.h"

namespace bonemill {
namespace {

constexpr int kScreenWidth = 1280, kScreenHeight = 800;
constexpr int kMostClicks = 2;

class RealStart : public testing::Test {
  protected:
    // Removed bone, mm^3; nothing: no session of this number is heard.
    std::optional<double> removed(uint32_t session) {
        if (!observer_)
            observer_.emplace(
                SubscriberOptions{.domain = testDomain(), .session = session, .name = "observer"});
        observer_->poll();
        return observer_->status() ? std::optional(observer_->status()->removed_mm3()) : std::nullopt;
    }
    test::StartRig::Session awaitSession() {
        std::optional<test::StartRig::Session> session;
        rig_.await("a session with its programs",
                   [&] { return (session = rig_.session()) && session->pids.contains("render_client"); });
        return *session;
    }
    static bool isScripted(const test::StartRig::Session& session) {
        return test::readFile("/proc/" + std::to_string(session.pids.at("device_daemon")) + "/cmdline")
                   .find(std::string("--device") + '\0' + "simulated") != std::string::npos;
    }
    void endSession() {
        test::run(rig_.words({"stop", "all"}));
        rig_.await("the window again", [&] { return isShown() && !rig_.session(); });
    }
    bool isShown() {
        return test::run({"/usr/bin/xdotool", "search", "--onlyvisible", "--name", "^bonemill: start$"})
                   .exit_code == 0;
    }

    test::StartRig rig_{kScreenWidth, kScreenHeight};
    std::optional<SceneSubscriber> observer_;
};

TEST_F(RealStart, TwoClicksLeadFromTheWindowToMilledBone) {
    const auto begin = std::chrono::steady_clock::now();
    const auto since = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    rig_.open();
    const double open_s = since();
    std::optional<test::StartRig::Session> session;
    rig_.await("a session", [&] {
        if (!session) rig_.click("tooth_corridor");  // until its cards are there nobody hears it
        return test::waitFor([&] { return (session = rig_.session()).has_value(); }, std::chrono::seconds(1));
    });
    const int lost_clicks = rig_.clicks() - 1;
    const double clicked_s = since();
    rig_.await("the mouse to hold the tool", [&] {
        return test::readFile(session->logs + "/device.log").find("holds the tool") != std::string::npos;
    });
    const double held_s = since();
    rig_.hold(kScreenWidth / 2, kScreenHeight / 2);
    rig_.await("milled bone", [&] {
        rig_.display().type({"click", "4"});  // the wheel, deeper
        return removed(session->number).value_or(0) > 0;
    });
    const double milled_s = since();
    EXPECT_LE(rig_.clicks() - lost_clicks, kMostClicks);
    std::cout << "window " << open_s << " s, session " << clicked_s << " s, tool in hand " << held_s
              << " s, milled " << milled_s << " s\n";
    RecordProperty("seconds_to_milled_bone", std::to_string(milled_s));
    EXPECT_FALSE(isShown()) << "the session's window is there alone";

    endSession();
    EXPECT_EQ(kill(rig_.window().pid(), 0), 0);
}

TEST_F(RealStart, AnotherCardAndTheScriptedHandAreStartedByKeysAndClicks) {
    rig_.open();
    std::optional<test::StartRig::Session> session;
    // The window may hear its clicks only from some of them on, also when it is back: then it is begun once
    // more.
    for (int attempt = 0; attempt < 4 && !(session && isScripted(*session)); ++attempt) {
        if (session) endSession();
        rig_.await("a session", [&] {
            for (int click = 0; click < 3; ++click) rig_.click("Scripted: it shows how");
            rig_.click("tooth_caries");
            return test::waitFor([&] { return rig_.session().has_value(); }, std::chrono::seconds(2));
        });
        session = awaitSession();
    }
    ASSERT_TRUE(isScripted(*session));
    rig_.await("bone that the scripted hand mills", [&] { return removed(session->number).value_or(0) > 0; });
}

// The twin asks and starts by the very script.
TEST_F(RealStart, WrongInputIsSaidInOneLine) {
    test::ClickedStart& start = rig_.twin();
    const auto problemOf = [&] {
        start.await([&] { return !start.desk.isBusy(); });
        start.look();
        EXPECT_TRUE(start.screen.find("problem"));
        EXPECT_EQ(start.desk.problem().find('\n'), std::string::npos);
        return start.desk.problem();
    };
    start.click("##host");
    start.type("no.such.pc.invalid");
    start.hit(Key::kEnter);
    EXPECT_NE(problemOf().find("no PC called no.such.pc.invalid is known here"), std::string::npos);
    start.click("Host a class");
    start.click("##class");
    start.type("a/b");
    start.click("minimal");
    EXPECT_NE(problemOf().find("--class a/b: give letters"), std::string::npos);
    start.click("Me alone");
    start.click("tooth_wall");
    EXPECT_NE(problemOf().find("which is no phantom"), std::string::npos);
}

// A terminal alone, or a PC without the viewer, has the help as before.
TEST_F(RealStart, WithoutADisplayTheHelpIsPrinted) {
    std::vector<std::string> words = rig_.words({});
    words.insert(words.begin() + 1, {"--unset=DISPLAY", "--unset=WAYLAND_DISPLAY"});
    const test::Finished finished = test::run(words);
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_EQ(finished.err.rfind("Usage: bonemill", 0), 0u) << finished.err;
    words.push_back("window");
    test::expectRefusal(test::run(words), "no display");
}

}  // namespace
}  // namespace bonemill

// The window to begin in, in every language: chosen by a click, and without words that are cut.
#include <gtest/gtest.h>
#include <imgui.h>

#include <cstdlib>

#include "tests/support/cut_words.h"
#include "tests/support/spoken.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/render_client/start_window/start_desk/fake_launcher.h"
#include "tests/unit/render_client/start_window/start_screen/clicked_start.h"

namespace bonemill {
namespace {

class StartLanguage : public testing::Test {
  protected:
    StartLanguage() {
        setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
        launcher_.put("doctor",
                      "Real time\tbetter\tno\tsudo x\nNetwork\tMISSING\tno\tsudo y\nDisplay\tok\tgood\n"
                      "hand\tgamepad\tmissing\tPad\tsudo z\n"
                      "hand\tmouse\tready\tin a window\tbonemill start --device pointer\n");
        launcher_.put("sessions", "/c/a.json\t/r.mcap\t2026-01-02 03:04\tSkull\tAnn\tscore 80 of 100\n");
        launcher_.put("found", "3\tskull\t14:05:09\tlab-pc-2\tlab\teth0\n");
        start_.emplace(launcher_.file(), 1280, 800);
    }

    test::TemporaryFolder folder_;
    test::FakeLauncher launcher_;
    std::optional<test::ClickedStart> start_;
};

TEST_F(StartLanguage, NoLanguageHasWordsThatAreCut) {
    start_->desk.choice().is_class = true;
    for (const Language& language : languages()) {
        const test::Spoken spoken(language.code);
        start_->look();
        int letters = 0;
        EXPECT_EQ(test::placesOfCuts(*start_->screen.stage().drawData(), letters), "") << language.name;
        EXPECT_GT(letters, 500) << language.name;
    }
}

TEST_F(StartLanguage, IsChosenAndRemembered) {
    const test::Spoken english(kEnglish);
    start_->click("Svenska");
    EXPECT_EQ(spokenLanguage(), "sv");
    EXPECT_EQ(wantedLanguage(), "sv") << "by the next window, too";
    EXPECT_TRUE(start_->screen.find("Handbok"));
    start_->click("English");
    EXPECT_TRUE(start_->screen.find("Handbook"));
}

}  // namespace
}  // namespace bonemill

// Clicks on attempts of before in the control panel, without OpenGL.
#include <gtest/gtest.h>

#include "tests/support/controlled_panel.h"

namespace bonemill {
namespace {

class PanelPast : public testing::Test, protected test::ControlledPanel {
  protected:
    PanelPast() {
        switchPanel();
        session_.past = &past_;
        session_.has_launcher = true;
        show();
    }
    void show() {
        for (int n = 0; n < 3; ++n) layOut(900, 2400);
    }
    void click(const std::string& label) {
        clickAt(label);
        show();
    }

    static PastAttempt attempt(const std::string& stem, const std::string& recording) {
        return {stem, recording, "2026-11-20 11:36", "Pedicle", "P07", "score 81 of 100", ""};
    }

    std::vector<PastAttempt> past_{attempt("/class/results/b", "/r/b.mcap"), attempt("/class/results/a", "")};
};

TEST_F(PanelPast, ReportAndReplayAreAClickAway) {
    click("Report##past 2");
    EXPECT_EQ(wishes_.open_file, "/class/results/a.html");
    click("Replay##past 1");
    EXPECT_EQ(wishes_.replay_of, "/class/results/b.json");
    EXPECT_FALSE(panel_.find("Replay##past 2")) << "it was not recorded";
}

TEST_F(PanelPast, AClipIsMadeOfTheReplayThatIsShown) {
    status_.mutable_replay()->set_length_s(100);
    show();
    EXPECT_FALSE(panel_.find("Clip")) << "nobody knows the recording";
    session_.recording = "/r/a.mcap";
    show();
    click("Clip");
    EXPECT_TRUE(wishes_.make_clip);
}

TEST_F(PanelPast, ARecordingGoesOnOtherwiseWhereSomethingIs) {
    status_.mutable_replay()->set_length_s(100);
    session_.recording = "/r/a.mcap";
    show();
    click("Go on otherwise");
    EXPECT_TRUE(wishes_.what_if.empty()) << "nothing is otherwise";
    click("What if pace");  // at its left end
    click("Go on otherwise");
    ASSERT_EQ(wishes_.what_if.size(), 2u);
    EXPECT_EQ(wishes_.what_if[0], "--pace");
    EXPECT_LT(std::stod(wishes_.what_if[1]), 1);
}

TEST_F(PanelPast, IsThereWhereTheLauncherIs) {
    EXPECT_TRUE(panel_.find("Report##past 1"));
    session_.has_launcher = false;
    show();
    EXPECT_FALSE(panel_.find("Report##past 1"));
}

}  // namespace
}  // namespace bonemill

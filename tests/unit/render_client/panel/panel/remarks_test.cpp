// Writes and erases notes in the control panel with a simulated mouse and keyboard, without OpenGL.
#include <gtest/gtest.h>

#include "common/dds/remark_bounds.h"
#include "tests/support/controlled_panel.h"

namespace bonemill {
namespace {

class PanelRemarks : public testing::Test, protected test::ControlledPanel {
  protected:
    PanelRemarks() {
        session_.role = topics::Viewer::OPERATOR;
        session_.remarks = &remarks_;
        switchPanel();
        show();
    }
    void show() { layOut(900, 2400); }
    void keep(uint32_t place, uint32_t number, const std::string& note) {
        topics::Remark& remark = remarks_[place];
        remark.set_number(number);
        remark.set_note(note);
        for (int n = 0; n < (note.empty() ? 6 : 0); ++n) remark.add_points_m(0);
    }
    void click(const std::string& label) {
        show();
        clickAt(label);
        show();
    }
    void writeAt(const std::optional<Eigen::Vector3d>& place) {
        wishes_.write_note = true;
        wishes_.note_place = place;
        show();
        wishes_ = {};
        for (int n = 0; n < 2; ++n) show();  // until ImGui has handed the keyboard over
    }
    bool type(const std::string& text) {
        bool is_taken = true;
        for (const char sign : text) is_taken = send(TextEvent{char32_t(sign)}) && is_taken;
        return is_taken;
    }
    bool press(Key key) {
        const bool is_taken = send(KeyEvent{key, true, false, {}});
        send(KeyEvent{key, false, false, {}});
        show();
        return is_taken;
    }

    std::map<uint32_t, topics::Remark> remarks_;
};

TEST_F(PanelRemarks, ANoteIsTypedAndSentWithItsPlace) {
    writeAt(Eigen::Vector3d(0.01, 0.02, 0.03));
    EXPECT_TRUE(type("mind the nerve")) << "none of the viewer's keys";
    EXPECT_TRUE(wishes_.commands.empty());
    EXPECT_TRUE(press(Key::kEnter));
    ASSERT_EQ(wishes_.commands.size(), 1u);
    const topics::Remark& note = wishes_.commands[0].add_remark();
    EXPECT_EQ(note.note(), "mind the nerve");
    ASSERT_EQ(note.points_m_size(), 3);
    EXPECT_FLOAT_EQ(note.points_m(2), 0.03f);
    show();
    EXPECT_FALSE(press(keyOf('P'))) << "keys are the viewer's again";
    wishes_ = {};
    writeAt(std::nullopt);
    type("second");
    press(Key::kEnter);
    ASSERT_EQ(wishes_.commands.size(), 1u);
    EXPECT_EQ(wishes_.commands[0].add_remark().note(), "second") << "nothing is left of the first";
    EXPECT_EQ(wishes_.commands[0].add_remark().points_m_size(), 0);
    wishes_ = {};
    writeAt(std::nullopt);
    type("  ");
    press(Key::kEnter);
    EXPECT_TRUE(wishes_.commands.empty());
}

TEST_F(PanelRemarks, ThePlaceCanBeGivenUp) {
    writeAt(Eigen::Vector3d(0.01, 0.02, 0.03));
    click("at the place on the bone");
    EXPECT_FALSE(panel_.find("at the place on the bone"));
    click("##note");
    type("anywhere");
    press(Key::kEnter);
    ASSERT_EQ(wishes_.commands.size(), 1u);
    EXPECT_EQ(wishes_.commands[0].add_remark().points_m_size(), 0);
}

TEST_F(PanelRemarks, EachCanBeErasedAndAllAfterAQuestion) {
    show();
    EXPECT_FALSE(panel_.find("Erase all")) << "there is nothing";
    keep(0, 7, "one");
    keep(1, 3, "");
    click("Erase 3");
    ASSERT_EQ(wishes_.commands.size(), 1u);
    EXPECT_EQ(wishes_.commands[0].erase_remark(), 3u);
    EXPECT_LT(panel_.find("Erase 7")->y, panel_.find("Erase 3")->y) << "the newest first";
    wishes_ = {};
    click("Erase all");
    EXPECT_TRUE(wishes_.commands.empty());
    ASSERT_TRUE(controls_.question(session_));
    controls_.answer(ViewerControls::Answer::kYes, session_, wishes_);
    ASSERT_EQ(wishes_.commands.size(), 1u);
    EXPECT_EQ(wishes_.commands[0].action_case(), topics::Command::kEraseRemark);
    EXPECT_EQ(wishes_.commands[0].erase_remark(), 0u);
}

TEST_F(PanelRemarks, BoxesDrawAndHideAndAListIsBounded) {
    for (uint32_t n = 0; n < kMaxRemarks; ++n) keep(n, n + 1, "note");
    click("Draw (Shift+L)");
    EXPECT_TRUE(controls_.isDrawing());
    click("Show (Shift+R)");
    EXPECT_FALSE(settings_.show_remarks);
    show();
    EXPECT_TRUE(panel_.find("Erase 256"));
    EXPECT_FALSE(panel_.find("Erase 200"));
    EXPECT_FALSE(panel_.find("Erase 216")) << "the 40 newest";
    wishes_ = {};
    session_.role = topics::Viewer::VIEWER;
    click("Erase 256");
    EXPECT_TRUE(wishes_.commands.empty());
}

}  // namespace
}  // namespace bonemill

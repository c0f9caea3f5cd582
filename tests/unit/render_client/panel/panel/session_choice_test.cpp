// Several sessions are offered: the user chooses one by mouse or by key.
#include <gtest/gtest.h>

#include "render_client/panel/panel/panel.h"
#include "tests/support/controlled_panel.h"

namespace bonemill {
namespace {

class SessionChoice : public testing::Test, protected test::ControlledPanel {
  protected:
    void layOut() { ControlledPanel::layOut(1280, 800); }
};

TEST_F(SessionChoice, IsThereWhereSessionsAreOffered) {
    layOut();
    EXPECT_EQ(panel_.drawData(), nullptr);
    session_.offered = {{4, "session 4: tooth"}, {9, "session 9: skull"}};
    layOut();
    EXPECT_NE(panel_.drawData(), nullptr);
    const auto place = panel_.find("session 9: skull");
    ASSERT_TRUE(place);
    send(MouseMoveEvent{*place});
    EXPECT_TRUE(send(MouseButtonEvent{MouseButton::kLeft, true, *place, {}, 0}));
    EXPECT_TRUE(send(MouseButtonEvent{MouseButton::kLeft, false, *place, {}, 0}));
    layOut();
    EXPECT_EQ(wishes_.session, 9u);
}

TEST_F(SessionChoice, NumbersChooseInTheOrderOfTheList) {
    EXPECT_FALSE(send(KeyEvent{keyOf('1'), true, false, {}})) << "it is an accuracy";
    session_.offered = {{4, "session 4: tooth"}, {9, "session 9: skull"}};
    layOut();
    EXPECT_TRUE(send(KeyEvent{keyOf('1'), true, false, {}}));
    EXPECT_EQ(wishes_.session, 4u);
    wishes_ = {};
    send(KeyEvent{keyOf('3'), true, false, {}});
    send(KeyEvent{keyOf('2'), false, false, {}});
    EXPECT_FALSE(wishes_.session);
}

}  // namespace
}  // namespace bonemill

#include <gtest/gtest.h>

#include "render_client/hand/controls/mouse_modes.h"
#include "tests/support/controlled_viewer.h"

namespace bonemill {
namespace {

constexpr int kPicture = 600;

// The panes stand at the right of a picture of 900 x 600.
class PaneMouseTest : public testing::Test, protected test::ControlledViewer {
  protected:
    PaneMouseTest() {
        settings_.slices.are_shown = true;
        look();
    }
    void look() {
        SeenPanes seen{{}, grid_, GreyWindow{2000, 800}};
        const auto rects = paneRects(settings_, 900, kPicture);
        for (size_t axis = 0; axis < 3; ++axis)
            seen.panes[axis] = makePane(grid_, Pose(), settings_.slices, axis, rects[axis], {});
        seen_ = seen;
        controls_.paneMouse().lookAt(seen_);
    }
    PixelPoint inPane(size_t axis) const {
        const PaneRect& rect = seen_->panes[axis].rect;
        return {rect.x + rect.width / 2.0, rect.y + rect.height / 2.0};
    }
    void send(const WindowEvent& event) {
        controls_.handle(event, kPicture, session_, wishes_);
        look();
    }
    void drag(PixelPoint from, double right, double down, MouseButton button = MouseButton::kLeft) {
        send(MouseButtonEvent{button, true, from, {}, time_ += 10});
        send(MouseMoveEvent{{from.x + right, from.y + down}});
        send(MouseButtonEvent{button, false, {from.x + right, from.y + down}, {}, time_ += 10});
    }

    DensityGrid grid_{{100, 80, 60}, {1e-3, 1e-3, 2e-3}, {0, 0, 0}, 16, -1000, 3000, 300};
    std::optional<SeenPanes> seen_;
    double time_ = 0;
};

TEST_F(PaneMouseTest, TheWheelScrollsThePaneUnderTheCursor) {
    const double distance = camera_.distance;
    send(MouseMoveEvent{inPane(2)});
    const double before = seen_->panes[2].position_W;
    send(ScrollEvent{3});
    EXPECT_NEAR(seen_->panes[2].position_W, before + 3 * 2e-3, 1e-9);
    EXPECT_FALSE(settings_.slices.positions[0] || settings_.slices.positions[1]);
    send(ScrollEvent{-1000});
    EXPECT_NEAR(seen_->panes[2].position_W, 0, 1e-9) << "the first slice";
    send(ScrollEvent{1});
    EXPECT_NEAR(seen_->panes[2].position_W, 2e-3, 1e-9) << "nothing is to be scrolled back first";
    EXPECT_EQ(camera_.distance, distance);
    send(MouseMoveEvent{{100, 100}});
    send(ScrollEvent{1});
    EXPECT_NE(camera_.distance, distance) << "beside the panes it zooms, as ever";
}

TEST_F(PaneMouseTest, ADragChangesWindowAndLevel) {
    const double edge = seen_->panes[0].rect.height, azimuth = camera_.azimuth;
    drag(inPane(1), edge / 8, 0);
    EXPECT_NEAR(settings_.slices.window->width, 2500, 1e-6);
    EXPECT_NEAR(settings_.slices.window->level, 800, 1e-6);
    drag(inPane(1), 0, -edge / 8);
    EXPECT_NEAR(settings_.slices.window->width, 2500, 1e-6);
    EXPECT_NEAR(settings_.slices.window->level, 300, 1e-6);
    drag(inPane(2), -200, 0);
    EXPECT_LT(settings_.slices.window->width, 2500) << "a drag that leaves the pane goes on";
    EXPECT_EQ(camera_.azimuth, azimuth);
    drag({100, 100}, 400, 0);
    EXPECT_NE(camera_.azimuth, azimuth) << "one that comes from the picture stays the camera's";
}

TEST_F(PaneMouseTest, ARightDragZoomsAndADoubleClickGoesBack) {
    drag(inPane(0), 0, -60, MouseButton::kRight);
    EXPECT_GT(settings_.slices.zoom, 1.2);
    drag(inPane(0), 0, 600, MouseButton::kRight);
    EXPECT_EQ(settings_.slices.zoom, 1);
    drag(inPane(0), 0, -60, MouseButton::kRight);
    drag(inPane(0), 30, 30);
    send(ScrollEvent{2});
    send(MouseMoveEvent{inPane(0)});
    send(ScrollEvent{2});
    ASSERT_TRUE(settings_.slices.positions[0]);
    for (int click = 0; click < 2; ++click)
        for (const bool is_down : {true, false})
            send(MouseButtonEvent{MouseButton::kLeft, is_down, inPane(0), {}, 1000 + 0.1 * click});
    EXPECT_FALSE(settings_.slices.positions[0]);
    EXPECT_FALSE(settings_.slices.window);
    EXPECT_EQ(settings_.slices.zoom, 1);
}

TEST_F(PaneMouseTest, WithoutPanesNothingIsTheirs) {
    PaneMouse mouse;
    SliceSettings slices;
    for (const WindowEvent& event :
         {WindowEvent(MouseMoveEvent{inPane(0)}), WindowEvent(ScrollEvent{1}),
          WindowEvent(MouseButtonEvent{MouseButton::kLeft, true, inPane(0), {}, 0})})
        EXPECT_FALSE(mouse.handle(event, false, slices));
}

TEST_F(PaneMouseTest, KeysSwitchPanesAndScan) {
    const auto type = [&](char letter) { send(KeyEvent{keyOf(letter), true, false, {true, false}}); };
    type('S');
    EXPECT_FALSE(settings_.slices.are_shown);
    type('S');
    EXPECT_TRUE(settings_.slices.are_shown);
    EXPECT_EQ(settings_.slices.ct, CtShown::kOnCuts);
    type('G');
    EXPECT_EQ(settings_.slices.ct, CtShown::kOnCutsAndMilled);
    type('G');
    EXPECT_EQ(settings_.slices.ct, CtShown::kMaterialsOnCuts);
    type('G');
    EXPECT_EQ(settings_.slices.ct, CtShown::kNowhere);
    type('G');
    EXPECT_EQ(settings_.slices.ct, CtShown::kOnCuts);
}

}  // namespace
}  // namespace bonemill

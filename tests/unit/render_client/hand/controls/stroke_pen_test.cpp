#include <gtest/gtest.h>

#include <cmath>

#include "common/dds/remark_bounds.h"
#include "render_client/hand/controls/mouse_modes.h"
#include "tests/support/controlled_viewer.h"

namespace bonemill {
namespace {

// A pixel is a tenth of a millimetre of a flat bone.
Eigen::Vector3d boneAt(const PixelPoint& at) {
    return {at.x * 1e-4, at.y * 1e-4, 0};
}

class Drawing : public testing::Test, protected test::ControlledViewer {
  protected:
    Drawing() { session_.role = topics::Viewer::OPERATOR; }
    void send(const WindowEvent& event) { controls_.handle(event, 500, session_, wishes_); }
    void type(Key key, bool with_shift) {
        send(KeyEvent{key, true, false, {with_shift, false}});
        send(KeyEvent{key, false, false, {with_shift, false}});
    }
    void drag(const std::vector<PixelPoint>& way, Modifiers held = {}) {
        send(MouseButtonEvent{MouseButton::kLeft, true, way.front(), held, 0});
        for (const PixelPoint& to : way) send(MouseMoveEvent{to});
        send(MouseButtonEvent{MouseButton::kLeft, false, way.back(), held, 0});
    }
    // What RemarkFeed does with a bone that is everywhere but in the columns of `gap`.
    std::vector<topics::Command> draw(double gap_from = 1e9, double gap_to = 1e9) {
        for (const PixelPoint& at : controls_.pen().takeWay())
            at.x >= gap_from&& at.x < gap_to ? controls_.pen().lift() : controls_.pen().add(boneAt(at));
        return controls_.pen().takeOrders("Anna");
    }
};

TEST_F(Drawing, ADragIsOneStrokeWhoseEndsAreTheMouses) {
    type(keyOf('L'), true);
    EXPECT_TRUE(controls_.isDrawing());
    const double azimuth = camera_.azimuth;
    drag({{100, 100}, {300, 100}, {300, 200}});
    EXPECT_EQ(camera_.azimuth, azimuth) << "it turns nothing";
    const auto orders = draw();
    ASSERT_EQ(orders.size(), 1u);
    const topics::Remark& stroke = orders[0].add_remark();
    EXPECT_TRUE(stroke.note().empty());
    EXPECT_EQ(stroke.color(), colourOfAuthor("Anna"));
    const int count = stroke.points_m_size() / 3;
    ASSERT_GE(count, 40);
    ASSERT_LE(count, 61) << "30 mm";
    EXPECT_FLOAT_EQ(stroke.points_m(0), 0.01f);
    EXPECT_NEAR(stroke.points_m(3 * count - 3), 0.03, 1e-6);
    EXPECT_NEAR(stroke.points_m(3 * count - 2), 0.02, 5e-4);
    for (int n = 1; n < count; ++n) {
        const auto step = [&](int axis) {
            return double(stroke.points_m(3 * n + axis)) - double(stroke.points_m(3 * n + axis - 3));
        };
        EXPECT_GE(std::hypot(step(0), step(1)), 0.5e-3 - 1e-6);
        EXPECT_LT(std::hypot(step(0), step(1)), 1.2e-3);
    }
    EXPECT_TRUE(draw().empty()) << "sent once";
    type(keyOf('L'), true);
    drag({{100, 100}, {300, 100}});
    EXPECT_TRUE(draw().empty());
    EXPECT_NE(camera_.azimuth, azimuth);
}

TEST_F(Drawing, CtrlAndShiftDrawAtOnce) {
    const Eigen::Vector3d target = camera_.target_W;
    drag({{100, 100}, {200, 100}}, {true, true});
    EXPECT_EQ(draw().size(), 1u);
    EXPECT_FALSE(controls_.isDrawing());
    EXPECT_EQ(camera_.target_W, target);
    drag({{100, 100}, {200, 100}}, {true, false});
    EXPECT_TRUE(draw().empty());
    EXPECT_NE(camera_.target_W, target) << "with Shift alone it pans";
}

TEST_F(Drawing, NothingIsOrderedBeforeTheButtonIsUpAndForAClick) {
    type(keyOf('L'), true);
    send(MouseButtonEvent{MouseButton::kLeft, true, {100, 100}, {}, 0});
    send(MouseMoveEvent{{200, 100}});
    EXPECT_TRUE(draw().empty());
    EXPECT_GT(controls_.pen().points().size(), 10u) << "but it is seen";
    send(MouseButtonEvent{MouseButton::kLeft, false, {200, 100}, {}, 0});
    EXPECT_EQ(draw().size(), 1u);
    EXPECT_TRUE(controls_.pen().points().empty());
    drag({{100, 100}});
    EXPECT_TRUE(draw().empty());
}

TEST_F(Drawing, AStrokeIsPartedWhereNoBoneIs) {
    type(keyOf('L'), true);
    drag({{100, 100}, {500, 100}});
    const auto orders = draw(250, 300);
    ASSERT_EQ(orders.size(), 2u);
    const auto& first = orders[0].add_remark().points_m();
    EXPECT_LT(first[first.size() - 3], 0.0251);
    EXPECT_GE(orders[1].add_remark().points_m(0), 0.0299);
    drag({{100, 100}, {500, 100}});
    for (const PixelPoint& at : controls_.pen().takeWay())  // a step of 20 mm in depth
        controls_.pen().add(boneAt(at) + Eigen::Vector3d(0, 0, at.x < 300 ? 0 : 0.02));
    EXPECT_EQ(controls_.pen().takeOrders("Anna").size(), 2u);
    drag({{0, 100}, {4000, 100}});
    int n = 0;
    for (const PixelPoint& at : controls_.pen().takeWay())
        ++n % 20 ? controls_.pen().add(boneAt(at)) : controls_.pen().lift();
    EXPECT_EQ(controls_.pen().takeOrders("Anna").size(), StrokePen::kMaxStrokes);
}

TEST_F(Drawing, ALongStrokeIsThinnedToWhatAServerTakes) {
    type(keyOf('L'), true);
    drag({{0, 0}, {9000, 0}});
    const auto orders = draw();
    ASSERT_EQ(orders.size(), 1u);
    const auto& points = orders[0].add_remark().points_m();
    EXPECT_LE(points.size(), 3 * kMaxRemarkPoints);
    EXPECT_GT(points.size(), 3 * kMaxRemarkPoints / 3);
    EXPECT_NEAR(points[points.size() - 3], 0.9, 1e-3);
    EXPECT_LT(orders[0].ByteSizeLong(), 4000u);
}

TEST_F(Drawing, WhoMayNotIsToldWhy) {
    session_.role = topics::Viewer::VIEWER;
    for (const char key : {'L', 'M'}) {
        wishes_ = {};
        type(keyOf(key), true);
        ASSERT_TRUE(wishes_.notice) << key;
        EXPECT_NE(wishes_.notice->text.find("only looks"), std::string::npos);
        EXPECT_FALSE(controls_.isDrawing() || wishes_.write_note || controls_.isPanelOpen());
    }
    drag({{100, 100}, {200, 100}}, {true, true});
    EXPECT_TRUE(draw().empty());
    session_.role = topics::Viewer::EXAMINER;
    settings_.stereo = StereoMode::kAnaglyph;
    wishes_ = {};
    type(keyOf('L'), true);
    EXPECT_FALSE(controls_.isDrawing());
    EXPECT_NE(wishes_.notice.value().text.find("stereo"), std::string::npos);
}

TEST_F(Drawing, EscapeEndsItBeforeItQuits) {
    settings_.show_remarks = false;
    type(keyOf('L'), true);
    EXPECT_TRUE(settings_.show_remarks) << "who draws sees it";
    type(Key::kEscape, false);
    EXPECT_FALSE(controls_.isDrawing());
    EXPECT_FALSE(controls_.question(session_));
    type(Key::kEscape, false);
    EXPECT_TRUE(controls_.question(session_));
}

TEST_F(Drawing, ANoteBelongsToWhereTheMouseIs) {
    send(MouseMoveEvent{{120, 80}});
    type(keyOf('M'), true);
    EXPECT_TRUE(wishes_.write_note && controls_.isPanelOpen());
    ASSERT_TRUE(wishes_.note_at);
    EXPECT_EQ(wishes_.note_at->x, 120);
    wishes_ = {};
    settings_.stereo = StereoMode::kAnaglyph;
    type(keyOf('M'), true);
    EXPECT_TRUE(wishes_.write_note);
    EXPECT_FALSE(wishes_.note_at) << "a pixel stands for no one place";
}

}  // namespace
}  // namespace bonemill

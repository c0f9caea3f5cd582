// Looks at the control panel's pixels, drawn off screen by the very code of the window.
#include <gtest/gtest.h>

#include <cstdlib>

#include "render_client/look/offscreen/osmesa_context.h"
#include "render_client/panel/panel/panel.h"
#include "tests/support/controlled_panel.h"

namespace bonemill {
namespace {

constexpr int kWidth = 640, kHeight = 480;

class PanelPicture : public testing::Test, protected test::ControlledPanel {
  protected:
    // Draws it over a mid-grey picture.
    Picture draw() {
        layOut(kWidth, kHeight);
        const GlApi& gl = context_.gl();
        gl.ClearColor(0.5f, 0.5f, 0.5f, 1);
        gl.Clear(GL_COLOR_BUFFER_BIT);
        painter_.paint(panel_, kWidth, kHeight);
        return context_.read();
    }

    OsmesaContext context_{kWidth, kHeight};
    PanelPainter painter_{context_.gl()};
};

size_t countDifferent(const Picture& a, const Picture& b, int left, int right) {
    size_t count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = left; x < right; ++x) count += a.at(x, y) != b.at(x, y);
    return count;
}

TEST_F(PanelPicture, AClosedPanelLeavesThePictureAlone) {
    const Picture picture = draw();
    EXPECT_EQ(countDifferent(picture, Picture(kWidth, kHeight), 0, kWidth), size_t(kWidth) * kHeight);
    EXPECT_EQ(picture.at(500, 100), picture.at(10, 10));
}

TEST_F(PanelPicture, AnOpenOneCoversTheRightSideAndNoMore) {
    const Picture closed = draw();
    switchPanel();
    const Picture picture = draw();
    EXPECT_EQ(countDifferent(picture, closed, 0, 290), 0u);
    EXPECT_GT(countDifferent(picture, closed, 300, kWidth), 300u * 440u);
    size_t bright = 0;  // the text
    for (int y = 20; y < kHeight - 20; ++y)
        for (int x = 300; x < kWidth - 20; ++x) bright += picture.at(x, y)[1] > 200;
    EXPECT_GT(bright, 1000u);
}

TEST_F(PanelPicture, TrainingIsShownWhereTheSceneTeachesCare) {
    switchPanel();
    const Picture without = draw();
    status_.mutable_training()->set_damaged_mm3(0.3);
    status_.mutable_training()->add_warnings("damaged facial nerve");
    for (int n = 0; n < 3; ++n) draw();  // until the scroll bar has settled
    EXPECT_GT(countDifferent(draw(), without, 300, kWidth), 20u);
}

TEST_F(PanelPicture, FaultsAreListedOnceThereAreSome) {
    switchPanel();
    const auto lookAtItsEnd = [this] {
        for (int n = 0; n < 3; ++n) draw();
        send(MouseMoveEvent{{500, 300}});
        for (int n = 0; n < 60; ++n) send(ScrollEvent{-1});
        return draw();
    };
    const Picture without = lookAtItsEnd();
    session_.faults = {{"The device sends nothing.", HudTone::kAlarm, 12, 34, 3, true}};
    const Picture with_faults = lookAtItsEnd();
    size_t red = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 300; x < kWidth; ++x) {
            const auto p = with_faults.at(x, y);
            red += p[0] > 150 && p[1] < 120 && p[2] < 120;
        }
    EXPECT_GT(countDifferent(with_faults, without, 300, kWidth), 100u);
    EXPECT_GT(red, 50u) << "it lasts";
}

TEST_F(PanelPicture, ABoxShowsWhatIsSet) {
    switchPanel();
    const Picture before = draw();
    const PixelPoint box = panel_.find("Cut X").value();
    settings_.cuts[0].is_on = true;
    const Picture after = draw();
    const int x = int(box.x), y = int(box.y);
    EXPECT_GT(after.at(x, y)[2], before.at(x, y)[2] + 60) << "the tick is in the middle of the box";
    EXPECT_EQ(countDifferent(before, after, 0, x - 20), 0u);
}

}  // namespace
}  // namespace bonemill

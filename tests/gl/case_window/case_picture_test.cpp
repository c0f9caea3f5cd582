// Looks at the pixels of make-case's window, drawn off screen by the very code of the window.
#include <gtest/gtest.h>

#include "render_client/case_window/case_desk/scan_slice.h"
#include "render_client/case_window/case_screen/screen_painter.h"
#include "render_client/look/offscreen/osmesa_context.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/render_client/case_window/case_screen/clicked_screen.h"

namespace bonemill {
namespace {

constexpr int kWidth = 1024, kHeight = 768;

class CasePicture : public testing::Test {
  protected:
    CasePicture() {
        test::writeHead(folder_.path() / "head");
        CaseRequest request;
        request.scan = folder_ / "head";
        request.at_mm = {15, 15, 20};
        request.size_mm = 10;
        screen_.emplace(request, kWidth, kHeight);
    }
    Picture draw() {
        screen_->look();
        painter_.paint(screen_->screen, screen_->screen.stage(), screen_->desk, kWidth, kHeight);
        return context_.read();
    }
    // Pixels near this colour in both pictures, on the pane with that control in its middle.
    int countOnBoth(const Picture& a, const Picture& b, const std::string& pane,
                    const std::array<int, 3>& colour) {
        const auto isNear = [&](const std::array<int, 3>& pixel) {
            for (size_t c = 0; c < 3; ++c)
                if (std::abs(pixel[c] - colour[c]) >= 40) return false;
            return true;
        };
        const PixelPoint middle = screen_->placeOf(pane);
        const int right = screen_->screen.boneWidth() / 2 - 2, down = screen_->screen.boneHeight() / 2 - 2;
        int count = 0;
        for (int y = int(middle.y) - down; y < int(middle.y) + down; ++y)
            for (int x = int(middle.x) - right; x < int(middle.x) + right; ++x)
                count += isNear(a.at(x, y)) && isNear(b.at(x, y));
        return count;
    }
    int countOn(const Picture& picture, const std::string& pane, const std::array<int, 3>& colour) {
        return countOnBoth(picture, picture, pane, colour);
    }

    static constexpr std::array<int, 3> kLine{kBoneLine[0], kBoneLine[1], kBoneLine[2]}, kBox{90, 225, 130},
        kArrow{255, 95, 140};
    test::TemporaryFolder folder_;
    std::optional<test::ClickedScreen> screen_;
    OsmesaContext context_{kWidth, kHeight};
    ScreenPainter painter_{context_.gl()};
};

TEST_F(CasePicture, SlicesShowBoneBoxAndArrow) {
    const Picture picture = draw();
    for (const char* const pane : {"Axial", "Coronal", "Sagittal"}) {
        EXPECT_GT(countOn(picture, pane, kLine), 200) << pane;
        EXPECT_GT(countOn(picture, pane, kBox), 200) << pane;
        EXPECT_GT(countOn(picture, pane, kArrow), 50) << pane;
    }
}

TEST_F(CasePicture, TheBoneIsSeenWithItsBoxAndLosesAPiece) {
    const Picture all = draw();
    const std::array<int, 3> kBone{205, 190, 160};
    const int seen = countOn(all, "bone", kBone);
    EXPECT_GT(seen, 1000);
    screen_->desk.keepPiece(0, false);  // the large ball
    EXPECT_LT(countOn(draw(), "bone", kBone), seen / 2);
}

TEST_F(CasePicture, TheLineGoesWithTheValue) {
    const Picture before = draw();
    const int drawn = countOn(before, "Coronal", kLine);
    screen_->desk.setIso(900);  // 0.9 mm further in
    const Picture after = draw();
    EXPECT_LT(countOnBoth(before, after, "Coronal", kLine), drawn / 4);
    EXPECT_GT(countOn(after, "Coronal", kLine), drawn / 2);
    screen_->desk.window = {.width = 1, .level = -5000};
    const Picture white = draw();
    EXPECT_GT(countOn(white, "Coronal", {255, 255, 255}),
              10 * (1 + countOn(after, "Coronal", {255, 255, 255})));
}

}  // namespace
}  // namespace bonemill

// The window of make-case without a window: whoever clicks from top to bottom has a case.
#include "render_client/case_window/case_screen/case_screen.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
#include "tests/unit/render_client/case_window/case_screen/clicked_screen.h"

namespace bonemill {
namespace {

class Screen : public testing::Test {
  protected:
    Screen() {
        test::writeHead(folder_.path() / "scans/head");
        request_.out = folder_ / "case";
    }
    test::ClickedScreen& open() {
        request_.scan = folder_ / "scans/head";
        return screen_.emplace(request_, 1280, 900);
    }
    // Pixels of the picture: where a pane shows a place in W.
    PixelPoint onPane(const char* title, size_t axis, const Eigen::Vector3d& p_W) {
        const PixelPoint middle = screen_->placeOf(title);
        const ScanPane& pane = screen_->screen.panes()[axis];
        const Eigen::Vector2d pixel = pane.toPixel(p_W);
        return {middle.x - pane.width / 2.0 + pixel.x(), middle.y - pane.height / 2.0 + pixel.y()};
    }

    test::TemporaryFolder folder_;
    CaseRequest request_;
    std::optional<test::ClickedScreen> screen_;
};

TEST_F(Screen, OpensWhatIsTyped) {
    test::ClickedScreen& screen = screen_.emplace(request_, 1280, 900);
    EXPECT_FALSE(screen.screen.find("iso-value"));
    screen.click("##scan");
    screen.type(folder_ / "scans/head");
    screen.hit(Key::kEnter);
    ASSERT_TRUE(screen.desk.scan());
    EXPECT_TRUE(screen.screen.find("iso-value"));
    EXPECT_EQ(screen.desk.request().series, test::kBoneSeries);
}

TEST_F(Screen, BrowsesToTheScan) {
    test::ClickedScreen& screen = screen_.emplace(request_, 1280, 900);
    screen.click("##scan");
    screen.type(folder_.path().string());
    screen.click("Browse");
    screen.click("scans/");
    screen.click("head/");
    screen.click("Open this folder");
    ASSERT_TRUE(screen.desk.scan());
}

TEST_F(Screen, ChoosesAnotherSeries) {
    test::ClickedScreen& screen = open();
    const size_t chosen = screen.desk.chosenSeries().value();
    screen.click("series " + std::to_string(2 - chosen));
    EXPECT_EQ(screen.desk.chosenSeries(), 1 - chosen);
    EXPECT_EQ(screen.desk.request().series, test::kSoftSeries);
}

TEST_F(Screen, TheMouseMovesCrossRegionAndHand) {
    test::ClickedScreen& screen = open();
    const Eigen::Vector3d top(15e-3, 15e-3, 20e-3);
    screen.clickAt(onPane("Coronal", 1, top));
    EXPECT_LT((screen.desk.marks().cross_W - top).cwiseProduct(Eigen::Vector3d(1, 0, 1)).norm(), 0.3e-3);
    screen.click("A part of it, with fine voxels");
    ASSERT_TRUE(screen.desk.isOfPart());
    const Eigen::Vector3d middle = screen.desk.marks().region_W->center();
    screen.drag(onPane("Coronal", 1, middle), onPane("Coronal", 1, middle - Eigen::Vector3d(2e-3, 0, 1e-3)));
    EXPECT_LT((screen.desk.marks().region_W->center() - middle + Eigen::Vector3d(2e-3, 0, 1e-3)).norm(),
              0.4e-3);
    ASSERT_TRUE(screen.desk.plan()) << screen.desk.planProblem();
    const CaseMarks marks = screen.desk.marks();
    const ScanPane& coronal = screen.screen.panes()[1];
    const Eigen::Vector2d handle = handleOf(coronal, *marks.start_W, *marks.hand_W);
    screen.drag(onPane("Coronal", 1, coronal.toWorld(handle)),
                onPane("Coronal", 1, *marks.start_W + Eigen::Vector3d(9e-3, 0, 1e-3)));
    ASSERT_TRUE(screen.desk.isHandChosen());
    EXPECT_GT(screen.desk.plan()->outwards.x(), 0.8);
}

TEST_F(Screen, TheWheelGoesThroughSlices) {
    test::ClickedScreen& screen = open();
    const double z = screen.desk.marks().cross_W.z();
    screen.moveTo(screen.placeOf("Axial"));
    screen.look();
    screen.screen.handle(ScrollEvent{-2});
    screen.look();
    EXPECT_NEAR(screen.desk.marks().cross_W.z(), z - 2e-3, 1e-9);
}

TEST_F(Screen, MovesTheIsoValueAndDropsAPiece) {
    test::ClickedScreen& screen = open();
    const double proposed = screen.desk.iso().value();
    const PixelPoint slider = screen.placeOf("iso-value");
    screen.clickAt({slider.x + 20, slider.y});
    EXPECT_NE(screen.desk.iso().value(), proposed);
    EXPECT_TRUE(screen.desk.isBoneOfNow()) << "it was looked for after the button was up";
    screen.click("Take the proposal");
    EXPECT_EQ(screen.desk.iso().value(), proposed);
    const PixelPoint piece = screen.placeOf("piece 2");
    screen.clickAt(piece);
    EXPECT_EQ(screen.desk.request().drop_pieces, std::vector<uint32_t>{2});
}

// The picture shows the piece ticked, and the button pressed, before bone was looked for anew.
TEST_F(Screen, KeepsClicksWhileItIsBusy) {
    test::ClickedScreen& screen = open();
    const PixelPoint piece = screen.placeOf("piece 2"), make = screen.placeOf("Make the case");
    const auto click = [&](const PixelPoint& place) {
        screen.moveTo(place);
        screen.press(place, true);
        screen.press(place, false);
    };
    screen.desk.setIso(400);
    while (screen.desk.busyWith().empty()) screen.desk.poll();
    click(make);
    EXPECT_TRUE(screen.desk.waitsToMake());
    screen.look();
    EXPECT_FALSE(screen.desk.madeScene().empty());
    screen.desk.keepPiece(0, false);
    while (screen.desk.busyWith().empty()) screen.desk.poll();
    click(piece);
    EXPECT_EQ(screen.desk.request().drop_pieces, (std::vector<uint32_t>{1, 2}));
    screen.look();
}

TEST_F(Screen, MakesTheCase) {
    test::ClickedScreen& screen = open();
    screen.screen.offerMilling();
    screen.click("burrs");
    screen.click("dental");
    screen.click("title");
    screen.type("A ball");
    screen.click("Make the case");
    ASSERT_FALSE(screen.desk.madeScene().empty()) << screen.desk.lines().back().text;
    EXPECT_TRUE(std::filesystem::exists(folder_ / "case/case.textproto"));
    EXPECT_EQ(screen.desk.request().title, "A ball");
    EXPECT_NE(screen.desk.request().tools.find("dental"), std::string::npos);
    EXPECT_EQ(screen.screen.takeMilling(), "");
    screen.click("Mill it");
    EXPECT_EQ(screen.screen.takeMilling(), screen.desk.madeScene());
    EXPECT_EQ(screen.screen.takeMilling(), "") << "once";
}

}  // namespace
}  // namespace bonemill

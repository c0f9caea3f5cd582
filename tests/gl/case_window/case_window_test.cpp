// deploy/make-case --window on a display in memory, clicked from top to bottom.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/gl/window/virtual_display.h"
#include "tests/support/process.h"
#include "tests/unit/render_client/case_window/case_screen/clicked_screen.h"

namespace bonemill {
namespace {

constexpr int kWidth = 1024, kHeight = 1000;  // all steps are seen without scrolling

class RealWindow : public testing::Test {
  protected:
    RealWindow() {
        setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
        setenv("LP_NUM_THREADS", "1", 1);
        test::writeHead(folder_.path() / "head");
    }
    // Runs beside a screen without a display that stands the same: it knows where everything is.
    void start(const std::vector<std::string>& more) {
        std::vector<std::string> words{test::sourceDir() + "/deploy/make-case",
                                       "--window",
                                       "--width",
                                       std::to_string(kWidth),
                                       "--height",
                                       std::to_string(kHeight)};
        words.insert(words.end(), more.begin(), more.end());
        window_.emplace(words);
    }
    static PixelPoint placeOf(test::ClickedScreen& twin, const std::string& label) {
        twin.look();
        return twin.screen.find(label).value();
    }
    void clickAt(const PixelPoint& place) {
        display_.type({"mousemove", std::to_string(int(place.x)), std::to_string(int(place.y))});
        display_.type({"click", "1"});
    }
    void expect(const std::string& what, const std::function<bool()>& holds) {
        ASSERT_TRUE(test::waitFor(holds)) << what << "\n" << window_->outSoFar() << window_->errSoFar();
    }

    test::TemporaryFolder folder_;
    test::VirtualDisplay display_{kWidth, kHeight};
    std::optional<test::Process> window_;
};

TEST_F(RealWindow, MakesACaseOfWhatIsTypedAndClicked) {
    CaseRequest request;
    request.out = folder_ / "case";
    test::ClickedScreen twin(request, kWidth, kHeight);
    start({"--out", request.out});
    // Until the window is there nothing can be typed into it: xdotool waits for it.
    display_.type({"search", "--sync", "--onlyvisible", "--name", "make a case"});
    clickAt(placeOf(twin, "##scan"));
    display_.type({"type", "--delay", "5", folder_ / "head"});
    display_.type({"key", "Return"});
    twin.desk.open(folder_ / "head");
    const PixelPoint make = placeOf(twin, "Make the case");
    const std::string scene = folder_ / "case/case.textproto";
    expect("the case", [&] {
        clickAt(make);  // disabled, or not yet there, until bone was found
        return std::filesystem::exists(scene);
    });
    EXPECT_NE(setUpScene(loadScene(scene)).bone, nullptr);
    expect("its pictures", [&] { return window_->outSoFar().find("mill it:") != std::string::npos; });
    EXPECT_TRUE(std::filesystem::exists(folder_ / "case/preview.png"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "case/case.png"));
}

TEST_F(RealWindow, LivesOnAfterAnError) {
    start({folder_ / "nowhere", "--out", folder_ / "case"});
    display_.type({"search", "--sync", "--onlyvisible", "--name", "make a case"});
    CaseRequest request;
    request.scan = folder_ / "nowhere";
    request.out = folder_ / "case";
    test::ClickedScreen twin(request, kWidth, kHeight);
    clickAt(placeOf(twin, "##scan"));
    display_.type({"key", "ctrl+a"});
    display_.type({"type", "--delay", "5", folder_ / "head"});
    display_.type({"key", "Return"});
    twin.desk.open(folder_ / "head");
    const PixelPoint make = placeOf(twin, "Make the case");
    expect("the case", [&] {
        clickAt(make);
        return std::filesystem::exists(folder_ / "case/case.textproto");
    });
}

}  // namespace
}  // namespace bonemill

// Looks at what a window remembers of its user, and at the full screen, on a display in memory. No server
// runs.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <memory>

#include "render_client/hand/window/glfw_window.h"
#include "tests/gl/window/virtual_display.h"
#include "tests/gl/window/windowed_viewer.h"

namespace bonemill {
namespace {

using test::kHeight;
using test::kWidth;

class RememberedWindow : public testing::Test {
  protected:
    RememberedWindow() : display_(kWidth, kHeight) {
        test::useSoftwareRenderer();
        setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
    }
    // A window that takes keys when this returns.
    std::unique_ptr<test::Process> start() {
        auto viewer = std::make_unique<test::Process>(std::vector<std::string>{
            "render_client", "--quality", "quick", "--domain", std::to_string(testDomain()), "--session",
            std::to_string(testSession())});
        EXPECT_TRUE(test::waitFor([&] { return viewer->errSoFar().find("window, ") != std::string::npos; }));
        display_.type({"mousemove", "100", "100"});
        return viewer;
    }
    // Presses the key once, and returns whether the file comes to say this.
    bool isSaidAfter(const std::string& key, const std::string& text) {
        display_.type({"key", key});
        return test::waitFor([&] { return said().find(text) != std::string::npos; });
    }
    std::string said() const {
        return std::filesystem::exists(file_) ? test::readFile(file_.string()) : std::string();
    }

    test::TemporaryFolder folder_;
    test::VirtualDisplay display_;
    const std::filesystem::path file_ = folder_.path() / "bonemill" / "viewer.json";
};

TEST_F(RememberedWindow, TheNextStartIsAsTheLastEnd) {
    for (const bool is_open : {true, false}) {
        const auto viewer = start();
        EXPECT_TRUE(isSaidAfter("m", is_open ? "\"panel_is_open\": true" : "\"panel_is_open\": false"))
            << said();
        viewer->signal(SIGTERM);
        EXPECT_EQ(viewer->wait().exit_code, 0);
    }
    EXPECT_EQ(said().find("quality"), std::string::npos) << "the command line's was for one start";
}

TEST_F(RememberedWindow, ItOpensWhereItWas) {
    std::filesystem::create_directories(file_.parent_path());
    test::writeFile(file_.string(), R"({"window": {"x": 60, "y": 50, "width": 200, "height": 150}})");
    const auto viewer = start();
    std::string place;
    EXPECT_TRUE(test::waitFor([&] {
        place = test::run({"/usr/bin/xdotool", "search", "--name", "^bonemill$", "getwindowgeometry"}).out;
        return place.find("Position: 60,50") != std::string::npos &&
               place.find("Geometry: 200x150") != std::string::npos;
    })) << place;
}

TEST_F(RememberedWindow, AFileThatMakesNoSenseIsALineInTheLog) {
    std::filesystem::create_directories(file_.parent_path());
    test::writeFile(file_.string(), "{\"camera\": \"sideways\"}");
    const auto viewer = start();
    viewer->signal(SIGTERM);
    const test::Finished finished = viewer->wait();
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_NE(finished.err.find("viewer.json: 'camera' has no value that it can have"), std::string::npos)
        << finished.err;
}

TEST_F(RememberedWindow, PicturesOffScreenAreNoBusinessOfTheFile) {
    std::filesystem::create_directories(file_.parent_path());
    test::writeFile(file_.string(), "nonsense");
    const test::Finished finished =
        test::run({"render_client", "--offscreen", "--size", "64x64", "--out", folder_ / "pictures",
                   "--domain", std::to_string(testDomain()), "--session", std::to_string(testSession())});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.err.find("viewer.json"), std::string::npos) << finished.err;
    EXPECT_EQ(said(), "nonsense");
}

// Takes the window's events until it has this size, which the display tells in its own time.
bool becomes(GlfwWindow& window, int width, int height) {
    return test::waitFor([&] {
        window.takeEvents();
        return window.pixelWidth() == width && window.pixelHeight() == height;
    });
}

TEST_F(RememberedWindow, AFullScreenGoesBackToWhereItWas) {
    const WindowPlace before{60, 50, kWidth / 2, kHeight / 2};
    GlfwWindow window(before.width, before.height, "small", "", before);
    ASSERT_TRUE(test::waitFor([&] {
        window.takeEvents();
        return window.place() == before;
    }));
    window.switchFullScreen();
    EXPECT_TRUE(becomes(window, kWidth, kHeight));
    EXPECT_TRUE(window.isFullScreen());
    EXPECT_EQ(window.place(), before) << "what is remembered is the window";
    window.switchFullScreen();
    EXPECT_TRUE(becomes(window, before.width, before.height));
    EXPECT_TRUE(test::waitFor([&] {
        window.takeEvents();
        return window.place() == before;
    }));
}

TEST_F(RememberedWindow, AWindowOfAScreenThatIsGoneOpensWhereItCanBeSeen) {
    GlfwWindow window(kWidth / 2, kHeight / 2, "small", "", WindowPlace{9000, 9000, kWidth / 2, kHeight / 2});
    window.takeEvents();
    EXPECT_LT(window.place().x, kWidth);
    EXPECT_LT(window.place().y, kHeight);
}

}  // namespace
}  // namespace bonemill

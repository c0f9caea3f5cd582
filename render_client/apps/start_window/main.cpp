// start_window is what bonemill shows without a word: a window to begin in (docs/howto/start.md).
#include <chrono>
#include <thread>
#include <utility>

#include "common/cli/command_line.h"
#include "common/process/run_program.h"
#include "render_client/hand/window/glfw_window.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/hud_canvas.h"
#include "render_client/start_window/start_desk/start_desk.h"
#include "render_client/start_window/start_screen/start_painter.h"
#include "render_client/start_window/start_screen/start_screen.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kMinFrame{15};  // where the display does not make the program wait
constexpr std::chrono::milliseconds kHidden{100};   // a session has the processors
// Where nobody does anything, pictures are rare: they cost a processor without a graphics card.
constexpr std::chrono::milliseconds kStill{500}, kRare{200};

struct WindowOptions {
    std::string launcher;
    std::vector<std::string> network;
    int width = 1280, height = 800;  // pixels
};

void addWindowOptions(CLI::App& app, WindowOptions& options) {
    app.add_option("--launcher", options.launcher, "bonemill's own script, which starts what is clicked")
        ->type_name("FILE")
        ->required()
        ->check(CLI::ExistingFile);
    app.add_option("network", options.network,
                   "options of the network, which all commands are given; after --");
    app.add_option("--width", options.width, "of the window, pixels")->check(CLI::Range(640, 16384));
    app.add_option("--height", options.height, "of the window, pixels")->check(CLI::Range(480, 16384));
}

class StartWindow {
  public:
    explicit StartWindow(const WindowOptions& options)
        : window_(options.width, options.height, "bonemill: start", "Without a display: bonemill --help"),
          desk_(options.launcher, options.network),
          screen_(desk_),
          painter_(window_.gl()) {
        window_.growWithText();
        screen_.stage().useClipboard([this] { return window_.clipboard(); },
                                     [this](const std::string& text) { window_.setClipboard(text); });
    }

    void run() {
        while (!window_.shouldClose()) {
            const Clock::time_point begin = Clock::now();
            desk_.poll();
            comeOrGo();
            showPicture();
            std::this_thread::sleep_until(begin + (is_visible_ ? kMinFrame : kHidden));
        }
    }

  private:
    // While what was started has a window of its own, there is no other.
    void comeOrGo() {
        if (std::exchange(is_visible_, !desk_.hasWindowOfItsOwn()) == !desk_.hasWindowOfItsOwn()) return;
        if (is_visible_) speak(wantedLanguage());  // the other window may have changed it
        window_.setVisible(is_visible_);
    }
    void showPicture() {
        const auto events = window_.takeEvents();
        const int width = window_.pixelWidth(), height = window_.pixelHeight();
        if (!is_visible_ || width < 1 || height < 1) return;  // hidden or minimised
        const Clock::time_point now = Clock::now();
        if (!events.empty()) last_event_ = now;
        if (now - last_event_ > kStill && now - last_picture_ < kRare) return;
        screen_.setPicture(width, height, textScale(width, height, 1, window_.contentScale()));
        for (const WindowEvent& event : events) screen_.handle(event);
        const std::chrono::duration<double> seconds = now - std::exchange(last_picture_, now);
        screen_.layOut(seconds.count());
        painter_.paint(screen_, width, height);
        window_.show();
    }

    GlfwWindow window_;
    StartDesk desk_;
    StartScreen screen_;
    StartPainter painter_;
    bool is_visible_ = true;
    Clock::time_point last_picture_ = Clock::now(), last_event_ = last_picture_;
};

int showWindow(int argc, char** argv) {
    CLI::App app("The window to begin in, which bonemill shows without a word", "start_window");
    WindowOptions options;
    addWindowOptions(app, options);
    if (!parseCommandLine(app, argc, argv, "start_window")) return 0;
    speak(wantedLanguage());
    StartWindow(options).run();
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::showWindow(argc, argv); });
}

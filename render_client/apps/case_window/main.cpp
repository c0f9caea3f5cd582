// case_window makes training cases of scans in a window (docs/howto/cases.md).
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>
#include <utility>

#include "common/cli/command_line.h"
#include "common/cli/version.h"
#include "common/process/run_program.h"
#include "common/process/standard_output.h"
#include "common/process/start_apart.h"
#include "haptic_server/cases/casework/case_request.h"
#include "haptic_server/scans/import/import_volume.h"
#include "render_client/case_window/case_screen/screen_painter.h"
#include "render_client/hand/window/glfw_window.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/hud_canvas.h"

namespace bonemill {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kMinFrame{15};  // where the display does not make the program wait

struct WindowOptions {
    CaseRequest request;
    std::string tools_folder;
    std::string command = "bonemill_lab make-case";
    std::string launcher;            // deploy/bonemill, which starts sessions; empty: none
    int width = 1400, height = 900;  // pixels
};

void addWindowOptions(CLI::App& app, WindowOptions& options) {
    addCaseOptions(app, options.request);
    app.get_option("scan")->required(false);
    app.get_option("--out")->required(false);
    app.add_option("--tools-folder", options.tools_folder, "sets of burrs to choose from, as deploy/tools")
        ->type_name("DIR");
    app.add_option("--command", options.command, "what people type for the same without a window")
        ->capture_default_str();
    app.add_option("--launcher", options.launcher,
                   "bonemill's own script: with it the window starts the case")
        ->type_name("FILE");
    app.add_option("--width", options.width, "of the window, pixels")->check(CLI::Range(640, 16384));
    app.add_option("--height", options.height, "of the window, pixels")->check(CLI::Range(480, 16384));
}

class CaseWindow {
  public:
    explicit CaseWindow(const WindowOptions& options)
        : desk_(options.request, versionText(), options.command),
          screen_(desk_, options.tools_folder),
          window_(options.width, options.height, "bonemill: make a case",
                  "Without a display use: " + options.command + " (see its --help)"),
          painter_(window_.gl()),
          launcher_(options.launcher) {
        if (!launcher_.empty()) screen_.offerMilling();
        screen_.stage().useClipboard([this] { return window_.clipboard(); },
                                     [this](const std::string& text) { window_.setClipboard(text); });
    }

    void run() {
        while (!window_.shouldClose()) {
            const Clock::time_point begin = Clock::now();
            showPicture();
            tell();
            mill();
            std::this_thread::sleep_until(begin + kMinFrame);
        }
    }

  private:
    void showPicture() {
        const int width = window_.pixelWidth(), height = window_.pixelHeight();
        const auto events = window_.takeEvents();
        desk_.poll();
        if (width < 1 || height < 1) return;  // minimised
        screen_.setPicture(width, height, textScale(width, height, 1, window_.contentScale()));
        for (const WindowEvent& event : events) screen_.handle(event);
        if (const auto dropped = window_.takeDropped(); !dropped.empty())
            screen_.openDropped(dropped.front());
        const std::chrono::duration<double> seconds =
            Clock::now() - std::exchange(last_picture_, Clock::now());
        screen_.layOut(seconds.count());
        painter_.paint(screen_, screen_.stage(), desk_, width, height);
        window_.show();
    }

    // deploy/make-case waits for this line, and makes pictures of the case.
    void tell() {
        if (std::exchange(told_scene_, desk_.madeScene()) == desk_.madeScene()) return;
        std::cout << "wrote " << desk_.madeScene() << std::endl;
    }

    // In a window of its own; this one goes on.
    void mill() {
        const std::string scene = screen_.takeMilling();
        if (scene.empty()) return;
        if (!startApart({launcher_, "start", scene}))
            std::cerr << launcher_ << " cannot be started" << std::endl;
    }

    CaseDesk desk_;
    CaseScreen screen_;
    GlfwWindow window_;
    ScreenPainter painter_;
    std::string launcher_;
    Clock::time_point last_picture_ = Clock::now();
    std::string told_scene_;
};

int makeCases(int argc, char** argv) {
    runReaderIfCalled(argc, argv);
    setReaderProgram("/proc/self/exe");
    CLI::App app("Makes training cases of scans in a window", "case_window");
    WindowOptions options;
    addWindowOptions(app, options);
    if (!parseCommandLine(app, argc, argv, "case_window")) return 0;
    umask(S_IRWXG | S_IRWXO);  // a case is its user's alone
    speak(wantedLanguage());
    CaseWindow(options).run();
    forgiveUnprinted();
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::makeCases(argc, argv); });
}

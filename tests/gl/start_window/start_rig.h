// bonemill without a word on a display in memory, with a home folder and programs of its own, and a twin of
// its window that knows where everything is.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/gl/window/virtual_display.h"
#include "tests/integration/deploy/bonemill_rig.h"
#include "tests/support/dds_session.h"
#include "tests/unit/render_client/start_window/start_screen/clicked_start.h"

namespace bonemill::test {

class StartRig {
  public:
    // The tooth's phantom is there already.
    StartRig(int width, int height);
    // Ends the window, and all with it.
    ~StartRig();

    // What somebody who sits at this display types.
    std::vector<std::string> words(const std::vector<std::string>& more) const;
    // Opens the window, and returns when it can be clicked. What is clicked there has the test's domain.
    void open();
    Process& window() { return *window_; }
    void click(const std::string& label);
    // A click anywhere, with the left button held from now on.
    void hold(int x, int y);
    int clicks() const { return clicks_; }

    // Of the session that the window has started; nothing: there is none (yet).
    struct Session {
        uint32_t number = 0;
        std::string logs;
        std::map<std::string, int> pids;  // of "bonemill", "haptic_server", "device_daemon", "render_client"
    };
    std::optional<Session> session() const;
    // Of all that runs from the rig's folder.
    std::vector<int> processes() const;
    void await(const std::string& what, const std::function<bool()>& holds) const;

    const VirtualDisplay& display() const { return display_; }
    ClickedStart& twin() { return *twin_; }

  private:
    VirtualDisplay display_;
    BonemillRig rig_;
    std::string launcher_;  // bonemill, for the twin
    std::unique_ptr<ClickedStart> twin_;
    std::unique_ptr<Process> window_;
    int clicks_ = 0;
};

}  // namespace bonemill::test

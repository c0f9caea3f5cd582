// A live session whose tool is held by the mouse in a real window: server, daemon and viewer.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tests/gl/window/virtual_display.h"

namespace bonemill::test {

inline constexpr int kMouseScreenWidth = 480, kMouseScreenHeight = 360;

// The words for a viewer of this test's session that draws by the processor.
std::vector<std::string> viewerWords(const std::vector<std::string>& more);

class MouseSession {
  public:
    // A slab lies below z = 2 mm, and the tool is held above it.
    MouseSession();

    Process& viewer() { return *viewer_; }
    std::string whatServerSaid() const { return server_->errSoFar(); }
    std::string whatDaemonSaid() const { return daemon_->errSoFar(); }

    // Ends the viewer, the daemon and the server in this order, each with SIGTERM.
    struct Ended {
        Finished viewer, daemon, server;
        std::string report;  // of the server, JSON
    };
    Ended end();

  private:
    TemporaryFolder folder_;
    std::unique_ptr<Process> server_, daemon_, viewer_;
};

}  // namespace bonemill::test

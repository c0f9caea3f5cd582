// Starts the viewer's program in a window on a display in memory.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/dds_session.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill::test {

inline constexpr int kWidth = 480, kHeight = 360;

// The renderer is as deterministic as its driver with one thread, and leaves the other core to the test.
inline void useSoftwareRenderer() {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("LP_NUM_THREADS", "1", 1);
}

// The viewer is in a window that covers the display.
class WindowedViewer {
  public:
    WindowedViewer(const std::string& name, const std::string& role, const std::string& more)
        : process_({"/bin/sh", "-c",
                    "cd " + folder_.path().string() + " && exec " + binDir() +
                        "/render_client --quality full --size " + std::to_string(kWidth) + "x" +
                        std::to_string(kHeight) + " --domain " + std::to_string(testDomain()) +
                        " --session " + std::to_string(testSession()) + " --name " + name + " --role " +
                        role + " " + more}) {}

    // Returns the picture of the next F12.
    std::filesystem::path nextPicture() {
        char name[32];
        std::snprintf(name, sizeof name, "bonemill_%04d.png", ++pictures_);
        return folder_.path() / name;
    }
    Process& process() { return process_; }

  private:
    TemporaryFolder folder_;
    Process process_;
    int pictures_ = 0;
};

}  // namespace bonemill::test

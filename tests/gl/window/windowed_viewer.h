// Starts the viewer's program in a window on a display in memory.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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
                    "cd " + folder_.path().string() + " && XDG_CONFIG_HOME=config exec " + binDir() +
                        "/render_client --quality full --size " + std::to_string(kWidth) + "x" +
                        std::to_string(kHeight) + " --domain " + std::to_string(testDomain()) +
                        " --session " + std::to_string(testSession()) + " --name " + name + " --role " +
                        role + " " + more}) {}

    // Returns the newest picture once F12 has made so many.
    std::optional<std::filesystem::path> picture(size_t count) const {
        std::vector<std::filesystem::path> pictures;
        std::error_code not_there;
        for (const auto& entry : std::filesystem::directory_iterator(pictures_in_, not_there))
            if (entry.path().filename().string().starts_with("bonemill_")) pictures.push_back(entry.path());
        if (pictures.size() < count) return std::nullopt;
        return *std::ranges::max_element(pictures, {},
                                         [](const auto& file) { return last_write_time(file); });
    }
    // F12's pictures lie there, and not where the viewer was started.
    void expectPicturesIn(const std::filesystem::path& folder) { pictures_in_ = folder; }
    // Counts one F12 more, and returns how many there were.
    size_t countPicture() { return ++pictures_; }
    Process& process() { return process_; }

  private:
    TemporaryFolder folder_;
    Process process_;
    std::filesystem::path pictures_in_ = folder_.path();
    size_t pictures_ = 0;
};

}  // namespace bonemill::test

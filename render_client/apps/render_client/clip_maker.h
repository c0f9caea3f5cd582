// Has bonemill write clips of the recording that is replayed here. It belongs to the render thread, which it
// does not keep waiting; a clip outlives the window that has asked for it.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "render_client/look/camera/camera.h"
#include "render_client/look/hud/hud.h"
#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

class ClipMaker {
  public:
    // Of the seconds around this moment of the recording, through this camera. One at a time: while one is
    // made another is not begun. Returns what the user should notice.
    HudNotice make(const ClientOptions& options, double moment_s, const OrbitCamera& camera,
                   const std::filesystem::path& file);
    // Once per picture: the clip is there, or has not come. Mostly nothing.
    std::optional<HudNotice> news();

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::minutes kLongest{10};
    static constexpr std::chrono::milliseconds kLookEvery{500};

    std::filesystem::path file_;  // that is being written; empty: none
    Clock::time_point begun_, looked_;
};

}  // namespace bonemill

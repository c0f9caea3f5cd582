// The scan as it is now, milling included, as one IMAGE for 3D Slicer: brought from the server when somebody
// asks, and let go of afterwards. For one thread.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "common/igtl_wire/igtl_port.h"
#include "render_client/link/subscribe/scene_subscriber.h"

namespace bonemill::igtl {

class ScanImage {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr uint64_t kMostVoxels = uint64_t(64) << 20;  // an image of 128 MiB
    // So many may wait at a time for peers who read slowly.
    static constexpr size_t kMostOnTheirWay = 3;
    static constexpr std::chrono::seconds kPatience{60};

    // Why there is none; empty: it is on its way, for everybody who asked.
    std::string ask(const SceneSubscriber& subscriber, Clock::time_point now);
    // Some peer has not taken it whole.
    size_t onTheirWay() const;
    bool isAsked() const noexcept { return is_asked_; }
    // After each poll. Returns the whole frame once it is here; null before, and when it was given up.
    Blob follow(SceneSubscriber& subscriber, Clock::time_point now);

  private:
    void end();

    DensityStore store_{size_t(384) << 20};
    bool is_asked_ = false;
    Clock::time_point asked_;
    std::vector<std::weak_ptr<const std::string>> made_;
};

}  // namespace bonemill::igtl

// Stands in for haptic_server on the device link: announces scenes, and answers every sample with no force.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

#include "common/config/scene_file.h"
#include "common/ipc/device_link.h"
#include "common/rt/clock.h"

namespace bonemill::test {

class SceneAnnouncer {
  public:
    explicit SceneAnnouncer(uint32_t session)
        : link_(DeviceLink::create(session, LinkSide::kServer)),
          thread_([this](const std::stop_token& stop) { live(stop); }) {}

    void announce(const std::string& file, uint64_t hash) {
        const std::lock_guard lock(mutex_);
        revision_ = link_.announceScene(file, hash);
    }
    void announce(const std::string& file) { announce(file, sceneHashOf(loadScene(file).scene)); }
    // The newest sample of this scene's device; all zero before there is one.
    DeviceSample sample() const {
        const std::lock_guard lock(mutex_);
        return sample_.scene_revision == revision_ ? sample_ : DeviceSample{};
    }
    bool hasDeviceLeft() const {
        const std::lock_guard lock(mutex_);
        return sample_.flags & kDeviceFlagLeaving;
    }
    std::atomic<uint32_t> reset_orders{0};

  private:
    void live(const std::stop_token& stop) {
        for (; !stop.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
            const std::lock_guard lock(mutex_);
            link_.readSample(sample_);
            WrenchCommand command{};
            command.stamp_ns = monotonicNowNs();
            command.answers_sequence = sample_.sequence;
            command.reset_orders = reset_orders;
            command.scene_revision = revision_;
            link_.writeCommand(command);
        }
    }

    mutable std::mutex mutex_;
    DeviceLink link_;
    uint32_t revision_ = 0;
    DeviceSample sample_{};
    std::jthread thread_;
};

}  // namespace bonemill::test

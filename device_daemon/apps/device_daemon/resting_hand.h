// Between two hands of one scene there is one that rests: the server hears of it, and takes the change for no
// silence.
//
// What it says is the last sample, which no motor stands behind any more: it is connected, stands still,
// presses no button, and its script has not ended.
#pragma once

#include <algorithm>
#include <chrono>
#include <iterator>
#include <thread>

#include "common/ipc/device_link.h"
#include "common/rt/clock.h"

namespace bonemill {

// RT-safe. Stamps are CLOCK_MONOTONIC ns.
inline DeviceSample restingAt(DeviceSample sample, int64_t now_ns) noexcept {
    std::fill(std::begin(sample.v_DT), std::end(sample.v_DT), 0.0);
    std::fill(std::begin(sample.w_DT), std::end(sample.w_DT), 0.0);
    sample.stamp_ns = now_ns;
    sample.buttons = 0;
    sample.state = uint32_t(SafetyState::kConnected);
    sample.flags &= ~uint32_t(kDeviceFlagScriptEnded | kDeviceFlagForceLimited | kDeviceFlagForceWaits);
    return sample;
}

// Says so for as long as it lives, from a thread of its own: nobody else writes to the link meanwhile, which
// must outlive it.
class RestingHand {
  public:
    RestingHand(DeviceLink& link, const DeviceSample& last)
        : thread_([&link, last](const std::stop_token& stop) {
              for (; !stop.stop_requested(); std::this_thread::sleep_for(kPeriod))
                  link.writeSample(restingAt(last, monotonicNowNs()));
          }) {}

  private:
    static constexpr std::chrono::milliseconds kPeriod{1};

    std::jthread thread_;
};

}  // namespace bonemill

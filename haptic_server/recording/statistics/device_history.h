// These are the states that the device went through in a run, and what stopped it. One normal thread calls
// it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "haptic_server/core/telemetry/tick_input.h"

namespace bonemill {

struct DeviceChange {
    double t_s;  // since the session's first tick
    DeviceReport now;
};

class DeviceHistory {
  public:
    // A device that comes and goes without end fills neither memory nor log.
    static constexpr size_t kMaxKept = 256;

    // A run is taken to begin engaged. Reports come in the order of their ticks.
    void add(double t_s, const DeviceReport& report);

    // The first kMaxKept changes, and how many there were in all.
    std::span<const DeviceChange> kept() const { return kept_; }
    uint64_t count() const { return count_; }

  private:
    DeviceReport last_;
    std::vector<DeviceChange> kept_;
    uint64_t count_ = 0;
};

// Says what has stopped the device: "too fast", "device fault 17"; empty if nothing has.
std::string causeText(const DeviceReport& report);
// Says it all for people: "protective stop: too fast. Hold the handle and reset."
std::string deviceText(const DeviceReport& report);

}  // namespace bonemill

// What happens in a session, in words for ROS 2: one line per event. It is for one thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/topics.pb.h"

namespace bonemill::ros2 {

class SaidEvents {
  public:
    void beginRun() { *this = {}; }
    // Each warning of the effects, by its name in topics::EffectState, once while it lasts; and the device's
    // states.
    std::vector<std::string> of(const topics::ToolState& state);
    // How orders ended: "order done: checkpoint 3".
    std::vector<std::string> of(const topics::Status& status);

  private:
    uint32_t events_ = 0;  // bits of the state before
    std::optional<uint32_t> device_state_, stop_cause_;
    std::optional<std::pair<uint64_t, uint32_t>> order_;  // sender and number
};

// CRTK's word for a SafetyState: DISABLED, ENABLED, PAUSED or FAULT.
const char* operatingStateOf(uint32_t safety_state);

}  // namespace bonemill::ros2

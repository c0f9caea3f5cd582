#include "render_client/peers/ros2_session/said_events.h"

#include <utility>

#include "common/device_messages/device_state.h"

namespace bonemill::ros2 {

std::vector<std::string> SaidEvents::of(const topics::ToolState& state) {
    std::vector<std::string> lines;
    const uint32_t before = std::exchange(events_, state.effects().events());
    for (uint32_t bit = 1; bit != 0 && bit <= topics::EffectState::Event_MAX; bit <<= 1)
        if (events_ & ~before & bit)
            lines.push_back(topics::EffectState::Event_Name(topics::EffectState::Event(bit)));
    const bool is_other = device_state_ != state.device_state() || stop_cause_ != state.stop_cause();
    device_state_ = state.device_state();
    stop_cause_ = state.stop_cause();
    if (!is_other) return lines;
    std::string line = std::string("device ") + bonemill::nameOf(SafetyState(state.device_state()));
    if (state.stop_cause() != uint32_t(StopCause::kNone))
        line += std::string(": ") + bonemill::nameOf(StopCause(state.stop_cause()));
    lines.push_back(std::move(line));
    return lines;
}

std::vector<std::string> SaidEvents::of(const topics::Status& status) {
    const std::pair order(status.last_command_sender(), status.last_command_sequence());
    if (order_ == order || order.first == 0) return {};
    order_ = order;
    const char* const how = status.last_command_outcome() == topics::REFUSED  ? "refused"
                            : status.last_command_outcome() == topics::FAILED ? "failed"
                                                                              : "done";
    return {std::string("order ") + how + ": " + status.last_command_result()};
}

const char* operatingStateOf(uint32_t safety_state) {
    switch (SafetyState(safety_state)) {
        case SafetyState::kEngaged:
            return "ENABLED";
        case SafetyState::kPaused:
            return "PAUSED";
        case SafetyState::kProtectiveStop:
        case SafetyState::kEmergencyStop:
        case SafetyState::kFault:
            return "FAULT";
        default:
            return "DISABLED";
    }
}

}  // namespace bonemill::ros2

#include "haptic_server/record/device_history.h"

namespace bonemill {

void DeviceHistory::add(double t_s, const DeviceReport& status) {
    const bool is_same = status.state == last_.state && status.stop_cause == last_.stop_cause &&
                         status.fault_code == last_.fault_code;
    if (is_same) return;
    last_ = status;
    ++count_;
    if (kept_.size() < kMostKept) kept_.push_back({t_s, status});
}

std::string causeText(const DeviceReport& status) {
    const auto cause = StopCause(status.stop_cause);
    if (cause == StopCause::kNone) return "";
    const std::string text = nameOf(cause);
    return cause == StopCause::kDeviceFault ? text + " " + std::to_string(status.fault_code) : text;
}

std::string deviceText(const DeviceReport& status) {
    const std::string text = nameOf(SafetyState(status.state)), cause = causeText(status);
    return cause.empty() ? text : text + ": " + cause + ". " + whatToDo(StopCause(status.stop_cause));
}

}  // namespace bonemill

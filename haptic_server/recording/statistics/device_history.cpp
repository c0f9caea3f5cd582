#include "haptic_server/recording/statistics/device_history.h"

namespace bonemill {

void DeviceHistory::add(double t_s, const DeviceReport& report) {
    const bool is_same = report.state == last_.state && report.stop_cause == last_.stop_cause &&
                         report.fault_code == last_.fault_code;
    if (is_same) return;
    last_ = report;
    ++count_;
    if (kept_.size() < kMaxKept) kept_.push_back({t_s, report});
}

std::string causeText(const DeviceReport& report) {
    const auto cause = StopCause(report.stop_cause);
    if (cause == StopCause::kNone) return "";
    const std::string text = nameOf(cause);
    return cause == StopCause::kDeviceFault ? text + " " + std::to_string(report.fault_code) : text;
}

std::string deviceText(const DeviceReport& report) {
    const std::string text = nameOf(SafetyState(report.state)), cause = causeText(report);
    return cause.empty() ? text : text + ": " + cause + ". " + whatToDo(StopCause(report.stop_cause));
}

}  // namespace bonemill

#include "device_daemon/bridges/bridge/self_test.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "common/text/printed_text.h"

namespace bonemill::bridge {

SelfTest::SelfTest(const ArmDescription& arm, double seconds, bool has_ramp)
    : seconds_(has_ramp ? std::max(seconds, kRampTime + ForceGate::kFadeTime) : seconds),
      has_ramp_(has_ramp),
      gate_({std::min(arm.max_force, kRampForce), 0}) {}

ArmOrder SelfTest::step(const ArmReading& reading, int64_t now_ns) noexcept {
    if (start_ns_ == 0) start_ns_ = now_ns;
    const int64_t before_ns = before_ns_.exchange(now_ns);
    if (before_ns != 0) intervals_.record(now_ns - before_ns);
    ++periods_;
    invalid_ += !reading.is_valid;
    failed_ += reading.has_failed;
    was_homed_ |= reading.is_homed;
    if (reading.is_valid) {
        const bool is_first = periods_ == invalid_ + 1;
        lowest_ = is_first ? reading.X_DT.position : lowest_.cwiseMin(reading.X_DT.position).eval();
        highest_ = is_first ? reading.X_DT.position : highest_.cwiseMax(reading.X_DT.position).eval();
    }
    const double time = secondsOfNs(now_ns - start_ns_);
    if (time >= seconds_) has_ended_ = true;
    const Wrench wrench_D = ramp(reading, time);
    const double elapsed = before_ns == 0 ? 0 : secondsOfNs(now_ns - before_ns);
    return {gate_.step(has_ended_ || shall_leave_ ? std::nullopt : std::optional(wrench_D), elapsed),
            has_pushed_};
}

Wrench SelfTest::ramp(const ArmReading& reading, double time) noexcept {
    if (!has_ramp_ || !reading.is_valid || !reading.is_homed || !reading.is_powered || !reading.is_enabled)
        return {};
    has_pushed_ = true;
    const double share = std::max(0.0, 1 - std::abs(2 * time / kRampTime - 1));  // 0, 1 in the middle, 0
    return {Eigen::Vector3d(0, 0, kRampForce * share), Eigen::Vector3d::Zero()};
}

std::vector<std::string> SelfTest::lines() const {
    std::vector<std::string> lines;
    const double rate = intervals_.count() ? double(kNsPerSecond) / intervals_.meanNs() : 0;
    const bool has_all = has_ended_ && invalid_ == 0 && failed_ == 0 && (!has_ramp_ || has_pushed_);
    lines.push_back(has_all                     ? "passed"
                    : has_ramp_ && !has_pushed_ ? "failed: the arm was not ready for force"
                    : !has_ended_               ? "failed: ended before its time"
                                                : "failed: the arm did not answer every time");
    lines.push_back(printed("periods: %.0f, without a pose %.0f, with an error %.0f", double(periods_),
                            double(invalid_), double(failed_)));
    lines.push_back(printed("rate: %.1f Hz", rate));
    lines.push_back(printed("interval: median %.3f ms, p99 %.3f ms, max %.3f ms",
                            millisecondsOfNs(double(intervals_.percentileNs(50))),
                            millisecondsOfNs(double(intervals_.percentileNs(99))),
                            millisecondsOfNs(double(intervals_.maxNs()))));
    lines.push_back(std::string("calibrated: ") + (was_homed_ ? "yes" : "no"));
    const Eigen::Vector3d range_mm = (highest_ - lowest_) * kPerMillimetre;
    lines.push_back(
        printed("the handle moved over x %.1f, y %.1f, z %.1f mm", range_mm.x(), range_mm.y(), range_mm.z()));
    return lines;
}

}  // namespace bonemill::bridge

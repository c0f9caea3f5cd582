#include "haptic_server/session/device_link_io.h"

#include <algorithm>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

// A healthy device is given this many periods before the tick goes on without it.
constexpr int64_t kPatiencePeriods = 2;

}  // namespace

DeviceLinkIo::DeviceLinkIo(const DeviceLinkIoConfig& config, DeviceLink& link,
                           SpscRing<TickRecord>& telemetry, SpscRing<Cut>& cuts)
    : config_(config),
      link_(link),
      telemetry_(telemetry),
      cuts_(cuts),
      ramp_(config.ramp),
      R_DW_(config.X_WD.rotation.conjugate()) {}

bool DeviceLinkIo::read(DeviceInput& input) noexcept {
    if (first_start_ns_ == 0 && !waitForFirstSample()) return false;
    if (is_stopping_.load(std::memory_order_relaxed) || hasDeviceLeft()) return false;
    const bool is_first = first_start_ns_ == 0;
    const int64_t due = is_first ? 0 : waitForDue();
    const int64_t start = monotonicNowNs();
    input.stale_factor = ramp_.update(start, sample_stamp_ns_);
    is_stale_ = ramp_.isStale();
    input.is_stale = is_stale_;
    input.X_WT_device = X_WT_device_;
    input.buttons = buttons_;
    if (is_first) first_start_ns_ = start;
    input.t_s = secondsOfNs(start - first_start_ns_);
    input.start_ns = start;
    input.deadline_ns = start + config_.period_ns;
    input.wakeup_latency_ns = is_first ? 0 : std::max<int64_t>(0, start - due);
    last_start_ns_ = start;
    return true;
}

int64_t DeviceLinkIo::waitForDue() noexcept {
    const int64_t patience = is_stale_ ? config_.period_ns : kPatiencePeriods * config_.period_ns;
    const int64_t deadline = last_start_ns_ + patience;
    link_.waitForSample(deadline);
    DeviceSample sample;
    if (!link_.readSample(sample) || sample.sequence == sequence_ || !take(sample)) return deadline;
    // The stamp comes from another process: never believe one from before the last tick or from the future.
    return std::clamp(sample.stamp_ns, last_start_ns_, std::max(last_start_ns_, monotonicNowNs()));
}

bool DeviceLinkIo::waitForFirstSample() noexcept {
    while (sequence_ == 0) {
        if (is_stopping_.load(std::memory_order_relaxed)) return false;
        const int64_t now = monotonicNowNs();
        link_.beat(now);
        DeviceSample sample;
        if (link_.waitForSample(now + kStopCheckNs) && link_.readSample(sample)) take(sample);
    }
    return true;
}

bool DeviceLinkIo::take(const DeviceSample& sample) noexcept {
    if (!isPlausible(sample)) {
        implausible_.fetch_add(1, std::memory_order_relaxed);
        return false;
    }
    const Eigen::Map<const Eigen::Vector3d> p_DT(sample.p_DT);
    const Eigen::Quaterniond q_DT(sample.q_DT[0], sample.q_DT[1], sample.q_DT[2], sample.q_DT[3]);
    X_WT_device_ = config_.X_WD * Pose{p_DT, q_DT.normalized()};
    buttons_ = sample.buttons;
    sequence_ = sample.sequence;
    if (sample.flags & kDeviceFlagLeaving) has_device_left_.store(true, std::memory_order_relaxed);
    sample_stamp_ns_ = sample.stamp_ns;
    return true;
}

int64_t DeviceLinkIo::write(const Wrench& wrench_hand_W) noexcept {
    const Wrench wrench_hand_D = wrench_hand_W.rotatedBy(R_DW_);
    WrenchCommand command{};
    command.stamp_ns = monotonicNowNs();
    Eigen::Map<Eigen::Vector3d>(command.f_hand_D) = wrench_hand_D.force;
    Eigen::Map<Eigen::Vector3d>(command.t_hand_D) = wrench_hand_D.torque;
    command.answers_sequence = sequence_;
    link_.writeCommand(command);
    return monotonicNowNs();
}

int64_t DeviceLinkIo::now() noexcept {
    return monotonicNowNs();
}

void DeviceLinkIo::push(const TickRecord& record) noexcept {
    telemetry_.tryPush(record);
    if (!record.cut.isEmpty()) cuts_.tryPush(record.cut);
}

}  // namespace bonemill

#include "haptic_server/server/session/device_link_io.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "common/rt/clock.h"
#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill {
namespace {

// A healthy device is given this many periods before the tick goes on without it.
constexpr int64_t kPatiencePeriods = 2;

void sleepUntil(int64_t instant_ns) noexcept {
    const timespec instant = timespecOfNs(instant_ns);
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &instant, nullptr) == EINTR) {
    }
}

}  // namespace

DeviceLinkIo::DeviceLinkIo(const DeviceLinkIoConfig& config, DeviceLink& link)
    : config_(config),
      link_(link),
      ramp_(config.ramp),
      R_DW_(config.X_WD.rotation.conjugate()),
      pace_(config.period_ns),
      lived_(config.period_ns) {}

bool DeviceLinkIo::read(DeviceInput& input) noexcept {
    if (first_start_ns_ == 0 && !waitForFirstSample()) return false;
    if (is_stopping_.load(std::memory_order_relaxed) || hasDeviceLeft()) return false;
    const bool is_first = first_start_ns_ == 0;
    const int64_t due = is_first ? 0 : waitForDue();
    const int64_t start = monotonicNowNs();
    input.stale_factor = ramp_.update(start, sample_stamp_ns_) * fadedTo(start);
    is_stale_ = ramp_.isStale();
    input.is_stale = is_stale_;
    input.X_WT_device = X_WT_device_;
    input.is_repeated = sequence_ == told_sequence_;
    told_sequence_ = sequence_;
    input.buttons = fade_start_ns_ == 0 ? buttons_ : 0;  // nobody mills what resists no more
    input.placements = placements_;
    input.device = device_;
    input.other_device = takeCapabilities() ? &capabilities_ : nullptr;
    input.faults = std::exchange(faults_, 0);
    if (is_first) first_start_ns_ = start;
    input.t_s = secondsOfNs(start - first_start_ns_);
    input.start_ns = start;
    input.deadline_ns = start + config_.period_ns;
    input.wakeup_latency_ns = is_first ? 0 : std::max<int64_t>(0, start - due);
    input.periods = lived_.begin(start);
    last_start_ns_ = start;
    pace_.begin(start);
    return true;
}

double DeviceLinkIo::fadedTo(int64_t now_ns) noexcept {
    if (!is_fading_.load(std::memory_order_relaxed)) {
        has_faded_.store(false, std::memory_order_relaxed);
        return 1;
    }
    if (fade_start_ns_ == 0) fade_start_ns_ = now_ns;
    const double whole_ns = double(std::max(kFadeNs, config_.ramp.ramp_down_ns));
    const double factor = std::max(0.0, 1 - double(now_ns - fade_start_ns_) / whole_ns);
    is_faded_ = factor == 0;
    return factor;
}

int64_t DeviceLinkIo::waitForDue() noexcept {
    const int64_t patience = is_stale_ ? config_.period_ns : kPatiencePeriods * config_.period_ns;
    const int64_t deadline = last_start_ns_ + patience;
    link_.waitForSample(deadline);
    const int64_t held_until = holdBack();
    if (!takeSample()) return std::max(deadline, held_until);
    // The stamp comes from another process: never believe one from before the last tick or from the future.
    const int64_t earliest = std::max(last_start_ns_, held_until);
    return std::clamp(sample_stamp_ns_, earliest, std::max(earliest, monotonicNowNs()));
}

int64_t DeviceLinkIo::holdBack() noexcept {
    const int64_t now = monotonicNowNs(), earliest = pace_.earliestNs();
    if (now >= earliest) return 0;
    if (pace_.isTooFast(now)) {
        early_.fetch_add(1, std::memory_order_relaxed);
        faults_ |= kFaultEarlySamples;
    }
    sleepUntil(earliest);
    return earliest;
}

bool DeviceLinkIo::waitForFirstSample() noexcept {
    while (sequence_ == 0) {
        if (is_stopping_.load(std::memory_order_relaxed) || hasDeviceLeft()) return false;
        const int64_t now = monotonicNowNs();
        link_.beat(now);
        if (link_.waitForSample(now + kStopCheckNs) && !takeSample()) sleepUntil(now + config_.period_ns);
    }
    return true;
}

bool DeviceLinkIo::takeSample() noexcept {
    DeviceSample sample;
    if (!link_.readSample(sample) || sample.sequence == sequence_) return false;
    if (sample.scene_revision != config_.scene_revision) {
        if (sample.flags & kDeviceFlagLeaving) has_device_left_.store(true, std::memory_order_relaxed);
        return false;
    }
    if (!isPlausible(sample) || (has_capabilities_ && !isWithinReach(sample, capabilities_))) {
        refuse();
        return false;
    }
    const Eigen::Map<const Eigen::Vector3d> p_DT(sample.p_DT);
    const Eigen::Quaterniond q_DT(sample.q_DT[0], sample.q_DT[1], sample.q_DT[2], sample.q_DT[3]);
    X_WT_device_ = config_.X_WD * config_.hand_space.poseAtTool({p_DT, q_DT.normalized()});
    buttons_ = sample.buttons;
    placements_ = sample.placements;
    device_ = {sample.state, sample.stop_cause, sample.fault_code, sample.flags};
    sequence_ = sample.sequence;
    if (sample.flags & kDeviceFlagLeaving) has_device_left_.store(true, std::memory_order_relaxed);
    sample_stamp_ns_ = sample.stamp_ns;
    return true;
}

// A daemon may say again and again what its device can do; the tick hears of it when that is something else.
bool DeviceLinkIo::takeCapabilities() noexcept {
    DeviceCapabilities capabilities;
    if (!link_.readCapabilities(capabilities)) return false;
    if (!isPlausible(capabilities)) {
        refuse();
        return false;
    }
    // Equal numbers with other bytes are told once more, which does no harm.
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    if (has_capabilities_ && std::memcmp(&capabilities, &capabilities_, sizeof capabilities) == 0)
        return false;
    capabilities_ = capabilities;
    has_capabilities_ = true;
    shown_.write(capabilities);
    return true;
}

void DeviceLinkIo::refuse() noexcept {
    implausible_.fetch_add(1, std::memory_order_relaxed);
    faults_ |= kFaultImplausibleDevice;
}

int64_t DeviceLinkIo::write(const Wrench& wrench_hand_W) noexcept {
    const Wrench wrench_hand_D = wrench_hand_W.rotatedBy(R_DW_);
    WrenchCommand command{};
    command.stamp_ns = monotonicNowNs();
    Eigen::Map<Eigen::Vector3d>(command.f_hand_D) = wrench_hand_D.force;
    Eigen::Map<Eigen::Vector3d>(command.t_hand_D) = wrench_hand_D.torque;
    command.answers_sequence = sequence_;
    command.reset_orders = reset_orders_.load(std::memory_order_relaxed);
    command.scene_revision = config_.scene_revision;
    link_.writeCommand(command);
    if (is_faded_) has_faded_.store(true, std::memory_order_relaxed);
    return monotonicNowNs();
}

int64_t DeviceLinkIo::now() noexcept {
    const int64_t now = monotonicNowNs();
    pace_.end(now);
    return now;
}

}  // namespace bonemill

// The tick sees the device of a live session through this: samples come from shared memory and wrenches go
// there, telemetry and cuts go into rings.
#pragma once

#include <atomic>

#include "common/ipc/device_link.h"
#include "common/ipc/stale_ramp.h"
#include "common/rt/spsc_ring.h"
#include "haptic_server/tick/tick_io.h"

namespace bonemill {

struct DeviceLinkIoConfig {
    int64_t period_ns = 1'000'000;
    StaleRampConfig ramp;
    Pose X_WD;
    bool ends_with_device = false;  // end the session when the device leaves in order
};

// All members but the constructor and stop() belong to the tick thread and are RT-safe; read() waits.
class DeviceLinkIo final : public TickIo {
  public:
    DeviceLinkIo(const DeviceLinkIoConfig& config, DeviceLink& link, SpscRing<TickRecord>& telemetry,
                 SpscRing<Cut>& cuts);

    // Wakes on a new device sample. When the device is silent it wakes by itself: two periods after the last
    // tick, and every period once the device counts as stale. Before the very first sample there is nothing
    // to simulate: it only waits. False after stop(), and when the device has said goodbye while
    // ends_with_device is set.
    bool read(DeviceInput& input) noexcept override;
    int64_t write(const Wrench& wrench_hand_W) noexcept override;
    int64_t now() noexcept override;
    void push(const TickRecord& record) noexcept override;

    // Any thread may call it, also a signal handler: read() returns false within kStopCheckNs.
    void stop() noexcept { is_stopping_.store(true, std::memory_order_relaxed); }
    // Any thread may ask for the number of samples that no daemon of ours would send.
    uint64_t implausibleSamples() const noexcept { return implausible_.load(std::memory_order_relaxed); }

    static constexpr int64_t kStopCheckNs = 50'000'000;

    // Any thread may ask whether the device has said goodbye; without ends_with_device it never has.
    bool hasDeviceLeft() const noexcept {
        return config_.ends_with_device && has_device_left_.load(std::memory_order_relaxed);
    }

  private:
    bool waitForFirstSample() noexcept;
    // Waits for the next tick and returns the instant that should have woken it.
    int64_t waitForDue() noexcept;
    bool take(const DeviceSample& sample) noexcept;  // false: implausible, refused

    DeviceLinkIoConfig config_;
    DeviceLink& link_;
    SpscRing<TickRecord>& telemetry_;
    SpscRing<Cut>& cuts_;
    StaleRamp ramp_;
    Eigen::Quaterniond R_DW_;
    Pose X_WT_device_;
    uint32_t buttons_ = 0;
    uint64_t sequence_ = 0;        // of the sample in use
    int64_t sample_stamp_ns_ = 0;  // when its joints were read
    int64_t first_start_ns_ = 0;
    int64_t last_start_ns_ = 0;
    bool is_stale_ = false;
    std::atomic<bool> is_stopping_{false};
    std::atomic<bool> has_device_left_{false};
    std::atomic<uint64_t> implausible_{0};
};

}  // namespace bonemill

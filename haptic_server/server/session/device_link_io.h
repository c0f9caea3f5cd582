// The tick sees the device of a live session through this: samples come from shared memory and wrenches go
// there, at the pace at which ticks may run. LivedPeriods and TickPace are for one thread, and RT-safe;
// DeviceLinkIo says its own. Times are CLOCK_MONOTONIC ns.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "common/geometry/hand_space.h"
#include "common/ipc/device_link.h"
#include "common/ipc/stale_ramp.h"
#include "common/rt/seqlock.h"
#include "haptic_server/core/tick/tick_io.h"

namespace bonemill {

// Says how many periods a tick lives through: a period in which no tick ran comes with the next one, so that
// what happens at a rate per time (milling, heat, the spindle) is not late on a machine that is.
class LivedPeriods {
  public:
    explicit LivedPeriods(int64_t period_ns) noexcept
        : period_ns_(period_ns), most_(std::max<int64_t>(1, kMaxNs / period_ns)) {}

    // A tick begins. On average the periods are as many as have passed, but for what a tick may not make up
    // for, which is lost.
    int begin(int64_t start_ns) noexcept {
        const int64_t ahead = kMaxAhead * period_ns_;
        lived_until_ns_ = std::clamp(lived_until_ns_, start_ns - most_ * period_ns_, start_ns + ahead);
        const int64_t late = std::max<int64_t>(0, start_ns - lived_until_ns_) / period_ns_;
        const int64_t periods = is_first_ ? 1 : std::clamp<int64_t>(late, 1, most_);
        lived_until_ns_ = is_first_ ? start_ns : lived_until_ns_ + periods * period_ns_;
        is_first_ = false;
        return int(periods);
    }

    static constexpr int64_t kMaxNs = 20'000'000;  // more is not made up for: a hand cannot follow it

  private:
    static constexpr int64_t kMaxAhead = 2;  // periods that ticks which came too early may have lived

    int64_t period_ns_, most_;
    int64_t lived_until_ns_ = 0;
    bool is_first_ = true;
};

// Says how early the next tick may start: one lives through a fixed time, so that ticks which come faster
// than their period would mill and move too fast. Two ticks are at least half a period apart, so that one
// that came late is soon caught up with; on average they are a period apart, but for the share by which
// another machine's clock may be faster. After its work a tick rests for a quarter as long: a thread with
// real-time priority that never rests is stopped by the kernel for some 50 ms in every second
// (sched_rt_runtime_us), and the force goes to zero.
class TickPace {
  public:
    explicit TickPace(int64_t period_ns) noexcept : period_ns_(period_ns) {}

    void begin(int64_t start_ns) noexcept {
        last_start_ns_ = start_ns;
        due_ns_ =
            std::max(due_ns_, start_ns - kMaxCaughtUp * period_ns_) + period_ns_ - period_ns_ / kFasterClock;
    }
    // The work of the tick that has begun is done.
    void end(int64_t end_ns) noexcept { rested_ns_ = end_ns + (end_ns - last_start_ns_) / kWorkPerRest; }
    int64_t earliestNs() const noexcept {
        return std::max({last_start_ns_ + period_ns_ / 2, due_ns_, rested_ns_});
    }
    // Tells whether an instant is too early because too many ticks came before it, and not just because the
    // last one was late.
    bool isTooFast(int64_t now_ns) const noexcept { return now_ns < due_ns_; }

  private:
    static constexpr int64_t kMaxCaughtUp = 2;   // periods that silence leaves to be made up for
    static constexpr int64_t kFasterClock = 64;  // 1/64, far more than crystals differ by
    static constexpr int64_t kWorkPerRest = 4;   // the loop takes no more than 80 % of its processor

    int64_t period_ns_;
    int64_t last_start_ns_ = INT64_MIN / 2;
    int64_t due_ns_ = INT64_MIN / 2;
    int64_t rested_ns_ = INT64_MIN / 2;
};

struct DeviceLinkIoConfig {
    int64_t period_ns = 1'000'000;
    StaleRampConfig ramp;
    Pose X_WD;
    HandSpace hand_space;
    bool ends_with_device = false;  // end the session when the device leaves in order
    uint32_t scene_revision =
        0;  // DeviceLink::announceScene(): samples of another scene's device do not count
};

// All members but the constructor and stop() belong to the tick thread and are RT-safe; read() waits.
class DeviceLinkIo final : public TickIo {
  public:
    DeviceLinkIo(const DeviceLinkIoConfig& config, DeviceLink& link);

    // Before the first read(): DeviceLink::announceScene() has given the scene this number.
    void beginScene(uint32_t revision) noexcept { config_.scene_revision = revision; }

    // Wakes on a new device sample, but no earlier than TickPace allows. When the device is silent it wakes
    // by itself: two periods after the last tick, and every period once the device counts as stale. Before
    // the very first sample there is nothing to simulate: it only waits. False after stop(), and when the
    // device has said goodbye while ends_with_device is set.
    bool read(DeviceInput& input) noexcept override;
    int64_t write(const Wrench& wrench_hand_W) noexcept override;
    int64_t now() noexcept override;

    // Any thread may order the force to fade, as before another scene; it does not come back.
    void fadeOut() noexcept { is_fading_.store(true, std::memory_order_relaxed); }
    // Any thread may ask whether the last wrench was zero for that; true also before the first tick.
    bool hasFadedOut() const noexcept { return has_faded_.load(std::memory_order_relaxed); }
    // It takes so long, or as long as the ramp of a silent device if that is longer: 25 N leave with 0.17
    // N/ms.
    static constexpr int64_t kFadeNs = 150'000'000;

    // Any thread may call it, also a signal handler: read() returns false within kStopCheckNs.
    void stop() noexcept { is_stopping_.store(true, std::memory_order_relaxed); }
    // Any thread may ask for the number of samples, and of devices, that no daemon of ours would tell of.
    uint64_t implausibleMessages() const noexcept { return implausible_.load(std::memory_order_relaxed); }
    // And for the number of ticks that were held back because samples came too fast.
    uint64_t earlySamples() const noexcept { return early_.load(std::memory_order_relaxed); }
    // And for what the device can do; false says that none has told yet.
    bool capabilities(DeviceCapabilities& capabilities) const noexcept {
        return shown_.tryRead(capabilities);
    }
    // Any thread may count up: each new number orders the device to come out of a stop. Relaxed is enough,
    // for nothing else goes with it.
    std::atomic<uint32_t>& resetOrders() noexcept { return reset_orders_; }

    static constexpr int64_t kStopCheckNs = 50'000'000;

    // Any thread may ask whether the device has said goodbye; without ends_with_device it never has.
    bool hasDeviceLeft() const noexcept {
        return config_.ends_with_device && has_device_left_.load(std::memory_order_relaxed);
    }

  private:
    bool waitForFirstSample() noexcept;
    double fadedTo(int64_t now_ns) noexcept;  // 1 to 0
    // Waits for the next tick and returns the instant that should have woken it.
    int64_t waitForDue() noexcept;
    // Sleeps until a tick may start. Returns that instant, or 0 if it has come already.
    int64_t holdBack() noexcept;
    bool takeSample() noexcept;        // false: there is none that is new and plausible
    bool takeCapabilities() noexcept;  // likewise, for another device
    void refuse() noexcept;

    DeviceLinkIoConfig config_;
    DeviceLink& link_;
    StaleRamp ramp_;
    Eigen::Quaterniond R_DW_;
    TickPace pace_;
    LivedPeriods lived_;
    Pose X_WT_device_;
    uint32_t buttons_ = 0;
    uint32_t placements_ = 0;
    DeviceReport device_;
    DeviceCapabilities capabilities_{};  // of the device in use
    bool has_capabilities_ = false;
    uint32_t faults_ = 0;          // TickFault bits for the tick that comes
    uint64_t sequence_ = 0;        // of the sample in use
    uint64_t told_sequence_ = 0;   // of the sample that the last read() told
    int64_t sample_stamp_ns_ = 0;  // when its joints were read
    int64_t first_start_ns_ = 0;
    int64_t last_start_ns_ = 0;
    bool is_stale_ = false;
    int64_t fade_start_ns_ = 0;
    bool is_faded_ = false;  // in this tick
    std::atomic<bool> is_stopping_{false};
    std::atomic<bool> is_fading_{false};
    std::atomic<bool> has_faded_{true};
    std::atomic<bool> has_device_left_{false};
    std::atomic<uint64_t> implausible_{0};
    std::atomic<uint64_t> early_{0};
    std::atomic<uint32_t> reset_orders_{0};
    Seqlock<DeviceCapabilities> shown_;  // capabilities_, for other threads
};

}  // namespace bonemill

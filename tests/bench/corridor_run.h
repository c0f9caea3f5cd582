// Mills the tooth's corridor in real time for as long as one likes; `loop` and `remesh` measure that.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "common/rt/latency_histogram.h"
#include "common/rt/periodic_timer.h"
#include "common/rt/realtime.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/tick/fixed_tick.h"

namespace bonemill::bench {

struct Waits {
    LatencyHistogram wake_up;  // from the due instant to the first instruction
    LatencyHistogram compute;
    uint64_t ticks = 0, missed = 0;
    uint64_t missed_by_compute = 0;  // ticks longer than their period
    uint32_t faults = 0;             // of all ticks
};
nlohmann::json toJson(const Waits& waits);

BoneModel corridorBone(int leaf_cells);
// It has the default tool, and the budget of a tick of haptic_server.
TickConfig corridorTick(double rate_hz);

// Makes the device go up and down the corridor by the clock, a little farther beside each time.
class CorridorIo final : public TickIo {
  public:
    CorridorIo(int64_t period_ns, double seconds, Waits& waits);

    bool read(DeviceInput& input) noexcept override;
    int64_t write(const Wrench&) noexcept override;
    int64_t now() noexcept override;
    // Does the ticks, with take(record) after each.
    template <class Take>
    void lead(FixedTick& tick, Take take) {
        tick.run(*this, [&](const TickRecord& record) {
            note(record);
            take(record);
        });
    }

  private:
    void note(const TickRecord& record) noexcept;

    PeriodicTimer timer_;
    int64_t period_ns_, end_ns_, start_ns_ = 0, first_ns_ = 0;
    Waits& waits_;
};

// Works on a thread of its own with the tick's priority, and says what the machine does not grant.
RealtimeReport inRealTime(const std::function<void()>& work);

}  // namespace bonemill::bench

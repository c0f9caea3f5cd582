// Mills the tooth's corridor in real time for as long as one likes; `loop` and `remesh` measure that.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

#include "common/rt/latency_histogram.h"
#include "common/rt/periodic_timer.h"
#include "common/rt/realtime.h"
#include "common/rt/spsc_ring.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/tick/tick_config.h"
#include "haptic_server/core/tick/tick_io.h"

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
    // `cuts` may be null.
    CorridorIo(int64_t period_ns, double seconds, Waits& waits, SpscRing<Cut>* cuts = nullptr);

    bool read(DeviceInput& input) noexcept override;
    int64_t write(const Wrench&) noexcept override;
    int64_t now() noexcept override;
    void push(const TickRecord& record) noexcept override;

  private:
    PeriodicTimer timer_;
    int64_t period_ns_, end_ns_, start_ns_ = 0, first_ns_ = 0;
    Waits& waits_;
    SpscRing<Cut>* cuts_;
};

// Works on a thread of its own with the tick's priority, and says what the machine does not grant.
RealtimeReport inRealTime(const std::function<void()>& work);

}  // namespace bonemill::bench

// Drives a HapticTick or FixedTick from a list of device inputs and keeps its records.
#pragma once

#include <vector>

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/core/tick/tick_io.h"

namespace bonemill::test {

class ScriptedIo final : public TickIo {
  public:
    explicit ScriptedIo(std::vector<DeviceInput> inputs) : inputs_(std::move(inputs)) {
        records.reserve(inputs_.size());
    }

    bool read(DeviceInput& input) noexcept override {
        if (next_ == inputs_.size()) return false;
        input = inputs_[next_++];
        input.start_ns = monotonicNowNs();
        return true;
    }
    int64_t write(const Wrench& wrench) noexcept override {
        last_wrench = wrench;
        return monotonicNowNs();
    }
    int64_t now() noexcept override { return monotonicNowNs(); }

    // Does one tick; false at the end of the inputs. There is memory for the records.
    template <class Tick>
    bool step(Tick& tick) noexcept {
        const TickRecord* record = tick.tick(*this);
        if (record) records.push_back(*record);
        return record;
    }
    // Does all that are left.
    template <class Tick>
    void lead(Tick& tick) noexcept {
        while (step(tick)) {
        }
    }

    std::vector<TickRecord> records;
    Wrench last_wrench;

  private:
    std::vector<DeviceInput> inputs_;
    size_t next_ = 0;
};

// The device moves straight from `from` to `to` with these buttons, one input per tick.
inline std::vector<DeviceInput> straightPath(const Pose& from, const Eigen::Vector3d& to, int ticks,
                                             uint32_t buttons) {
    std::vector<DeviceInput> inputs(size_t(ticks), DeviceInput{});
    for (int n = 0; n < ticks; ++n) {
        inputs[size_t(n)].X_WT_device = {
            from.position + (to - from.position) * (double(n) / std::max(1, ticks - 1)), from.rotation};
        inputs[size_t(n)].buttons = buttons;
        inputs[size_t(n)].t_s = n * kMillisecond;
    }
    return inputs;
}

}  // namespace bonemill::test

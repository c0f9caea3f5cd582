// Drives HapticTick from a list of device inputs and keeps what it said.
#pragma once

#include <vector>

#include "common/base/units.h"
#include "common/rt/clock.h"
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
    void push(const TickRecord& record) noexcept override { records.push_back(record); }  // reserved above

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

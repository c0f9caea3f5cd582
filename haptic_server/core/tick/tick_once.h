// Hands a tick its input without a device: time comes with the input, and the clock only tells how long the
// tick took. It is for one normal thread.
#pragma once

#include "common/rt/clock.h"
#include "haptic_server/core/tick/haptic_tick.h"
#include "haptic_server/core/tick/tick_io.h"

namespace bonemill {

// Does one tick. The record is good until the next one.
inline const TickRecord& tickOnce(HapticTick& tick, const DeviceInput& input) noexcept {
    class HandedIn final : public TickIo {
      public:
        explicit HandedIn(const DeviceInput& input) noexcept : input_(input) {}
        bool read(DeviceInput& input) noexcept override {
            input = input_;
            input.start_ns = monotonicNowNs();
            return true;
        }
        int64_t write(const Wrench&) noexcept override { return monotonicNowNs(); }
        int64_t now() noexcept override { return monotonicNowNs(); }

      private:
        const DeviceInput& input_;
    };
    HandedIn io(input);
    return *tick.tick(io);
}

}  // namespace bonemill

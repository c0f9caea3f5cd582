// This is what the simulated hand does beside moving the handle: it holds the enabling switch and presses the
// button to reset, as a person would who wants to go on.
//
// Times are CLOCK_MONOTONIC ns. It is RT-safe, for one thread.
#pragma once

#include <cstdint>

#include "device_daemon/ares/wire/drive_state.h"

namespace bonemill {

class HandScript {
  public:
    struct View {
        wire::DriveState drive = wire::DriveState::kNotReady;
        bool is_engaged = false;  // the hand feels haptic_server
    };

    // Once per period.
    void update(const View& view, int64_t now_ns) noexcept;

    bool holdsEnablingSwitch() const noexcept { return holds_switch_; }
    bool pressesReset() const noexcept { return presses_reset_; }

  private:
    void pressSwitchAnew(const View& view, int64_t now_ns) noexcept;
    void pressResetInTrouble(const View& view, int64_t now_ns) noexcept;

    bool has_begun_ = false;
    bool has_pressed_ = false;
    bool holds_switch_ = false;
    bool presses_reset_ = false;
    bool was_faulty_ = false;
    int64_t switch_pressed_ns_ = 0;  // the last time that it was let go in order to press it
    int64_t quiet_since_ns_ = 0;     // from here on nothing has worked
};

}  // namespace bonemill

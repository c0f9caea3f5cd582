#include "device_daemon/hands/input/evdev_state.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace bonemill {

double EvdevAxis::fromCentre() const noexcept {
    if (!exists()) return 0;
    const double middle = std::midpoint(double(min), double(max));
    return std::clamp((value - middle) / (max - middle), -1.0, 1.0);
}

void EvdevStream::take(std::span<const std::byte> bytes) noexcept {
    for (const std::byte byte : bytes) {
        event_[filled_++] = byte;
        if (filled_ < event_.size()) continue;
        input_event event;
        std::memcpy(&event, event_.data(), sizeof event);
        filled_ = 0;
        takeEvent(event);
    }
}

void EvdevStream::takeEvent(const input_event& event) noexcept {
    if (event.type == EV_SYN && event.code == SYN_DROPPED) {
        is_skipping_ = true;
    } else if (event.type == EV_SYN && event.code == SYN_REPORT) {
        needs_refresh_ |= is_skipping_;
        is_skipping_ = false;
    } else if (is_skipping_) {
        return;
    } else if (event.type == EV_KEY && event.code < KEY_CNT) {
        state_.keys[event.code] = event.value != 0;  // 2 is a repeated key
    } else if (event.type == EV_ABS && event.code < ABS_CNT) {
        state_.axes[event.code].value = event.value;
    }
}

}  // namespace bonemill

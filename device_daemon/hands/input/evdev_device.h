// Opens an input device of the kernel (/dev/input/event*), asks it what it is like, and understands what it
// says. It makes system calls and allocates; it is not for the loop.
#pragma once

#include <linux/input.h>

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace bonemill {

// Keeps what an input device holds down and where its axes stand, from the bytes that its file gives, in
// whatever pieces they arrive. When the kernel has dropped events, what is kept is wrong until it is asked
// for anew: needsRefresh() says so. It is a plain value for one thread, and no bytes break it.
struct EvdevAxis {
    int32_t value = 0;
    int32_t min = 0;
    int32_t max = 0;  // there is no such axis unless it is above min

    bool exists() const noexcept { return max > min; }
    // -1 to 1 between the ends; 0 where there is no such axis.
    double fromCentre() const noexcept;
    // 0 to 1 from the lower end.
    double fromEnd() const noexcept { return exists() ? (fromCentre() + 1) / 2 : 0; }
};

struct EvdevState {
    std::bitset<KEY_CNT> keys;  // held down
    std::array<EvdevAxis, ABS_CNT> axes;
};

class EvdevStream {
  public:
    // Starts with what the device is like before its first event.
    explicit EvdevStream(const EvdevState& state = {}) noexcept : state_(state) {}

    void take(std::span<const std::byte> bytes) noexcept;

    const EvdevState& state() const noexcept { return state_; }
    bool needsRefresh() const noexcept { return needs_refresh_; }
    void refresh(const EvdevState& state) noexcept {
        state_ = state;
        needs_refresh_ = false;
    }

  private:
    void takeEvent(const input_event& event) noexcept;

    EvdevState state_;
    std::array<std::byte, sizeof(input_event)> event_;
    size_t filled_ = 0;
    bool is_skipping_ = false;  // until the end of the report in which events were dropped
    bool needs_refresh_ = false;
};

struct EvdevDevice {
    int file = -1;  // the receiver closes it
    std::string name = {};
    EvdevState state = {};
    bool has_rumble = false;  // it can, and its file may be written
};

// Nothing comes of a path that does not exist, may not be read, or is no input device. An exclusive device is
// heard by no other program from then on: the desktop would take a pedal's key for typing.
std::optional<EvdevDevice> openEvdev(const std::string& path, bool is_exclusive);

// Returns an input device that is there now, or nothing; called on a reading thread.
using EvdevOpener = std::function<std::optional<EvdevDevice>()>;

// Asks for what is held down and where the axes stand. False says that the device does not answer.
bool refreshEvdev(int file, EvdevState& state);

// Hands these bytes of the file to the stream, and asks the device when events were dropped. False says that
// it does not answer.
bool takeEvents(int file, std::span<const std::byte> bytes, EvdevStream& stream);

}  // namespace bonemill

// A foot pedal that presses buttons beside any device: whoever owns the loop ORs buttons() into what the
// device says.
//
// Foot pedals are keyboards with one to three keys, so any key or button of an input device serves. buttons()
// is RT-safe, for any thread; a thread of this class reads the pedal. An unplugged pedal is released.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "device_daemon/hands/input/evdev_device.h"
#include "device_daemon/hands/input/input_reader.h"

namespace bonemill {

// Codes are the kernel's: KEY_B, BTN_0, ...
struct PedalKeys {
    std::optional<uint16_t> remove = {};  // without it every key that is not `add`
    std::optional<uint16_t> add = {};
};

class PedalSource final : private InputSource {
  public:
    // The path is that of /dev/input; those in by-id stay the same when the pedal is plugged in again. An
    // exclusive pedal types nothing into the desktop. Nothing need be there yet. Throws UserError for a code
    // that no key has.
    PedalSource(const std::string& path, const PedalKeys& keys, bool is_exclusive);
    PedalSource(EvdevOpener opener, const PedalKeys& keys);

    uint32_t buttons() const noexcept { return buttons_.load(std::memory_order_relaxed); }
    bool isThere() const noexcept { return is_there_.load(std::memory_order_relaxed); }

  private:
    int open() override;
    bool take(std::span<const std::byte> bytes) override;
    void lost() override;
    void tell() noexcept;

    const EvdevOpener opener_;
    const PedalKeys keys_;
    std::atomic<uint32_t> buttons_ = 0;
    std::atomic<bool> is_there_ = false;

    // These belong to the reading thread.
    int file_ = -1;
    EvdevStream stream_;

    InputReader reader_;
};

}  // namespace bonemill

// A foot pedal that presses the button to remove beside any device: whoever owns the loop ORs buttons() into
// what the device says.
//
// Foot pedals are keyboards with one to three keys, so any key or button of an input device serves. buttons()
// is RT-safe, for any thread; a thread of this class reads the pedal. An unplugged pedal is released.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

#include "device_daemon/hands/input/evdev_device.h"
#include "device_daemon/hands/input/input_reader.h"

namespace bonemill {

class PedalSource final : private InputSource {
  public:
    // Nothing need be there yet.
    explicit PedalSource(EvdevOpener opener) : opener_(std::move(opener)), reader_(*this) {}

    uint32_t buttons() const noexcept { return buttons_.load(std::memory_order_relaxed); }
    bool isThere() const noexcept { return is_there_.load(std::memory_order_relaxed); }

  private:
    int open() override;
    bool take(std::span<const std::byte> bytes) override;
    void lost() override;
    void tell() noexcept;

    const EvdevOpener opener_;
    std::atomic<uint32_t> buttons_ = 0;
    std::atomic<bool> is_there_ = false;

    // These belong to the reading thread.
    int file_ = -1;
    EvdevStream stream_;

    InputReader reader_;
};

}  // namespace bonemill

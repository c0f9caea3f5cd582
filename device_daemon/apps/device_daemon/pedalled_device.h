// A device with a foot pedal beside it: the pedal's buttons count as the device's own.
//
// RT-safe as far as the device is; for the loop's thread.
#pragma once

#include <memory>
#include <utility>

#include "device_daemon/control/haptic_device/haptic_device.h"
#include "device_daemon/hands/input/pedal_source.h"

namespace bonemill {

class PedalledDevice final : public HapticDevice {
  public:
    PedalledDevice(std::unique_ptr<HapticDevice> device, const std::string& pedal_path)
        : device_(std::move(device)), pedal_(pedal_path, {}, true) {}

    DeviceCapabilities capabilities() const noexcept override { return device_->capabilities(); }
    uint32_t capabilitiesVersion() const noexcept override { return device_->capabilitiesVersion(); }
    const char* refusedFigure() const noexcept override { return device_->refusedFigure(); }
    bool hasClock() const noexcept override { return device_->hasClock(); }
    bool waitForSample(int64_t deadline_ns) noexcept override { return device_->waitForSample(deadline_ns); }
    bool read(double elapsed, DeviceReading& reading) noexcept override {
        const bool is_heard = device_->read(elapsed, reading);
        reading.buttons |= pedal_.buttons();
        return is_heard;
    }
    void write(const DeviceOrder& order) noexcept override { device_->write(order); }
    void beginAttempt() noexcept override { device_->beginAttempt(); }
    void followRun(uint64_t epoch) noexcept override { device_->followRun(epoch); }
    std::string refusal() const override { return device_->refusal(); }

  private:
    std::unique_ptr<HapticDevice> device_;
    PedalSource pedal_;
};

}  // namespace bonemill

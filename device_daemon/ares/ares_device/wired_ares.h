// ARES with its joints behind the wire: a real controller, or the emulated one.
//
// Geometry and limits are the scene's, and the controller describes its own (docs/reference/ares_link.md).
// Where the two differ by more than 0.1 %, poses would be wrong or forces too large: such a controller is
// refused for good. Its motors are never wanted, read() returns false with kDeviceFault and the code
// kAresIsAnother, and refusal() says what differs.
//
// Making one throws UserError. Everything else but refusal() is RT-safe but for the socket's system calls,
// and for the loop's thread.
#pragma once

#include <atomic>

#include "device_daemon/ares/ares_device/ares_device.h"
#include "device_daemon/ares/driver/udp_device.h"
#include "device_daemon/ares/wire/packets.h"

namespace bonemill {

inline constexpr uint32_t kAresIsAnother = 0xA0000002;  // a fault code: the controller is not the scene's

class WiredAres final : public HapticDevice {
  public:
    WiredAres(const AresDeviceConfig& config, UdpDeviceConfig wire);

    // Only the controller knows whether there is an enabling switch.
    DeviceCapabilities capabilities() const noexcept override;
    uint32_t capabilitiesVersion() const noexcept override {
        return ares_.capabilitiesVersion() + joints_.descriptionCount();
    }
    const char* refusedFigure() const noexcept override { return joints_.session().refusedFigure(); }
    bool hasClock() const noexcept override { return ares_.hasClock(); }
    bool waitForSample(int64_t deadline_ns) noexcept override { return ares_.waitForSample(deadline_ns); }
    bool read(double elapsed, DeviceReading& reading) noexcept override;
    void write(const DeviceOrder& order) noexcept override;
    std::string refusal() const override;

  private:
    void checkDescription() noexcept;

    AresDeviceConfig config_;
    wire::Endpoint controller_;
    UdpJointDevice joints_;
    AresDevice ares_;
    uint32_t checked_description_ = 0;
    wire::Describe refused_{};  // written once, before the flag that lets others read it
    std::atomic<bool> is_refused_ = false;
};

}  // namespace bonemill

// This is any device whose own program, a bridge, speaks poses and wrenches over the UDP wire
// (docs/lab/ares_link.md).
//
// read() returns false for a pose that is none and after a pose that jumped (pose_guard.h); status, buttons,
// fault and motors' load of the reading are filled all the same, and its pose is not. Of a silent bridge
// nothing is.
//
// Making one throws UserError. Everything else is RT-safe but for the socket's system calls; one thread uses
// it.
#pragma once

#include <utility>

#include "device_daemon/ares/driver/pose_differentiator.h"
#include "device_daemon/ares/driver/pose_guard.h"
#include "device_daemon/ares/driver/udp_device.h"
#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill {

class UdpPoseDevice final : public HapticDevice {
  public:
    explicit UdpPoseDevice(UdpDeviceConfig config) : device_(std::move(config)) {}

    // Of nothing until the bridge has described itself.
    DeviceCapabilities capabilities() const noexcept override;
    uint32_t capabilitiesVersion() const noexcept override {
        return 1 + device_.session().descriptionCount();
    }
    const char* refusedFigure() const noexcept override { return device_.session().refusedFigure(); }
    bool hasClock() const noexcept override { return true; }
    bool waitForSample(int64_t deadline_ns) noexcept override { return device_.waitForSample(deadline_ns); }
    bool read(double elapsed, DeviceReading& reading) noexcept override;
    void write(const DeviceOrder& order) noexcept override;

    const wire::HostSession<wire::PosePackets>& session() const noexcept { return device_.session(); }
    wire::Endpoint local() const noexcept { return device_.local(); }

  private:
    bool isBelieved(const wire::PoseState& state, const Pose& X_DT, uint32_t status) noexcept;
    void readMotion(const wire::PoseState& state, DeviceReading& reading) noexcept;

    UdpDevice<wire::PosePackets> device_;
    PoseGuard guard_;
    uint32_t guarded_description_ = 0;  // whose session the guard has seen
    PoseDifferentiator differentiator_;
};

}  // namespace bonemill

// This is a motion controller with the six axes of ARES behind the UDP wire (docs/lab/ares_link.md).
//
// Making one throws UserError. Everything else is RT-safe but for the socket's system calls; one thread uses
// it.
#pragma once

#include <utility>

#include "device_daemon/ares/driver/joint_device.h"
#include "device_daemon/ares/driver/udp_device.h"

namespace bonemill {

class UdpJointDevice final : public JointDevice {
  public:
    explicit UdpJointDevice(UdpDeviceConfig config) : device_(std::move(config)) {}

    bool hasClock() const noexcept override { return true; }
    bool waitForSample(int64_t deadline_ns) noexcept override { return device_.waitForSample(deadline_ns); }
    bool readJoints(double elapsed, JointReading& reading) noexcept override;
    void applyForces(const JointOrder& order) noexcept override;

    // What the controller said of itself last; null before it has. The count changes with each description.
    const wire::Describe* description() const noexcept;
    uint32_t descriptionCount() const noexcept { return device_.session().descriptionCount(); }

    const wire::HostSession<wire::JointPackets>& session() const noexcept { return device_.session(); }
    wire::Endpoint local() const noexcept { return device_.local(); }

  private:
    UdpDevice<wire::JointPackets> device_;
};

}  // namespace bonemill

// This is what every device behind the UDP wire has in common, and the one with joints: the link, the way to
// "operation enabled" and back, homing, and the reset of faults.
//
// Making one throws UserError. Everything else is RT-safe but for the socket's system calls; one thread uses
// it.
#pragma once

#include <cstdint>
#include <utility>

#include "common/device_messages/device_messages.h"
#include "device_daemon/ares/driver/joint_device.h"
#include "device_daemon/ares/wire/host_session.h"
#include "device_daemon/ares/wire/packets.h"
#include "device_daemon/control/haptic_device/haptic_device.h"

namespace bonemill {

// Returns the Button bits of the inputs.
uint32_t buttonsOf(uint32_t inputs) noexcept;

struct UdpDeviceConfig {
    wire::Endpoint controller;
    wire::UdpSocket socket{};  // what the host sends from
    uint32_t watchdog_us = 0;  // 0: the controller's own
};

template <class Packets>
class UdpDevice {
  public:
    using State = typename Packets::State;
    using Command = typename Packets::Command;

    explicit UdpDevice(UdpDeviceConfig config)
        : link_({.controller = config.controller,
                 .watchdog_us = config.watchdog_us,
                 .seed = wire::randomSeed()},
                std::move(config.socket)) {}

    bool waitForSample(int64_t deadline_ns) noexcept { return link_.waitForState(deadline_ns); }

    // Returns the newest state; null when the controller is silent, or has just said what are no numbers.
    const State* read() noexcept;
    // The second was so.
    bool isNonsense() const noexcept { return is_nonsense_; }
    // Of that state.
    uint32_t status() const noexcept;
    // The first cause in the period in which it is heard, since who hears it latches it; from then on the
    // gravest of all that are there or latched, so that none hides behind another.
    StopCause fault() const noexcept;

    // What the loop asks, of an order for joints or for a pose.
    struct Wish {
        bool is_wanted = false;
        bool is_engaged = false;
        bool reset = false;
    };
    // Sends a command that holds the forces already.
    void write(Command& command, const Wish& wish) noexcept;

    const wire::HostSession<Packets>& session() const noexcept { return link_.session(); }
    wire::Endpoint local() const noexcept { return link_.local(); }

  private:
    uint16_t controlword(const Wish& wish) noexcept;

    wire::HostLink<Packets> link_;
    uint32_t told_nonsense_ = 0;  // of the session's count
    bool is_nonsense_ = false;
    uint32_t newest_fault_ = 0;  // the controller's first fault
    uint32_t told_fault_ = 0;    // the same, in the period before
    int resets_left_ = 0;        // commands that still carry the order to reset
};

extern template class UdpDevice<wire::JointPackets>;
extern template class UdpDevice<wire::PosePackets>;

// This is a motion controller with the six axes of ARES behind the UDP wire (docs/reference/ares_link.md).
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

// A host and a controller with a scripted wire between them, without sockets or clocks.
#pragma once

#include <cstring>
#include <functional>
#include <span>
#include <vector>

#include "device_daemon/ares/wire/controller_session.h"
#include "device_daemon/ares/wire/host_session.h"

namespace bonemill::wire::test {

using Bytes = std::vector<std::byte>;

template <class Packet>
Bytes copyOf(const Packet& packet) {
    const auto bytes = bytesOf(packet);
    return {bytes.begin(), bytes.end()};
}

// Changes a sealed packet and seals it again with the same numbers.
template <class Packet>
Bytes changed(const Bytes& bytes, const std::function<void(Packet&)>& change) {
    Packet packet = *open<Packet>(bytes);
    change(packet);
    seal(packet, packet.header.session, packet.header.sequence);
    return test::copyOf(packet);
}

inline constexpr Endpoint kControllerPlace{kLoopback, 4040};
inline constexpr Endpoint kHostPlace{kLoopback, 4041};
inline constexpr int64_t kPeriodNs = 1'000'000;

inline Describe aresDescription() {
    Describe d{};
    std::strcpy(d.name, "test ARES");
    d.max_force = 50;
    d.max_torque = 1;
    d.workspace_radius = 0.1;
    d.max_actuator_force = 50;
    d.encoder_step = 5e-6;
    d.stroke = 0.151;
    d.watchdog_us = kDefaultWatchdogUs;
    d.rate_hz = 1000;
    d.kind = 1;
    return d;
}

// Each period the controller sends a state, the host answers it, and the controller steps. `on_state` and
// `on_command` stand between them: what they return arrives.
struct Pair {
    using Wire = std::function<std::vector<Bytes>(const Bytes&)>;

    HostSession<JointPackets> host{{.controller = kControllerPlace, .seed = 7}};
    ControllerSession<JointPackets> controller{aresDescription()};
    Wire on_state = [](const Bytes& b) { return std::vector<Bytes>{b}; };
    Wire on_command = [](const Bytes& b) { return std::vector<Bytes>{b}; };
    int64_t now_ns = 1'000'000'000;
    bool is_wanted = true;
    bool host_sends = true;
    bool resets = false;
    uint32_t device_faults = 0;
    float force = 1;

    void period() {
        now_ns += kPeriodNs;
        if (const DescribeRequest* request = host.requestDue(now_ns)) deliverToController(copyOf(*request));
        if (controller.hasHost()) {
            JointState state{};
            state.inputs = kInputChainClosed | kInputHomed;
            controller.seal(state, now_ns);
            for (const Bytes& bytes : on_state(copyOf(state))) host.take(bytes, kControllerPlace, now_ns);
        }
        sendCommand();
        controller.step(device_faults, true, now_ns);
    }

    void run(int periods) {
        for (int i = 0; i < periods; ++i) period();
    }

    void sendCommand() {
        if (!host_sends) return;
        JointCommand command{};
        command.controlword =
            resets ? uint16_t(kControlFaultReset)
                   : controlwordTowards(is_wanted && host.isTrusted(), driveStateOf(host.state().statusword));
        command.mode = kModeTorque;
        for (float& f : command.force) f = force;
        if (!host.seal(command, now_ns)) return;
        for (const Bytes& bytes : on_command(copyOf(command))) deliverToController(bytes);
    }

    void deliverToController(const Bytes& bytes, const Endpoint& from = kHostPlace) {
        if (controller.take(bytes, from, now_ns) == Taken::kRequest) {
            host.take(controller.sealDescription(), kControllerPlace, now_ns);
        }
    }

    bool isEnabled() const { return controller.drive().state() == DriveState::kOperationEnabled; }
    bool hasForce() const { return controller.commandInForce(now_ns) != nullptr; }
};

}  // namespace bonemill::wire::test

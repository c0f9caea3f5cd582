// This is the controller's side of the wire, without a socket and without a clock: it answers the host that
// asks, believes that host's commands, and lets force flow only while all is well.
//
// A host is adopted when there is none, or when the same one, silent for longer than the watchdog, asks anew.
// The controller calls take() for what comes, then step() once per period, then asks commandInForce(). Times
// are CLOCK_MONOTONIC ns. It is RT-safe, for one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "device_daemon/ares/wire/drive_state.h"
#include "device_daemon/ares/wire/packet_flow.h"
#include "device_daemon/ares/wire/packets.h"
#include "device_daemon/ares/wire/udp_socket.h"

namespace bonemill::wire {

// A host that is silent for so long gets no more states, and another one may take its place.
inline constexpr int64_t kForgetHostAfterNs = 1'000'000'000;

enum class Taken {
    kNothing,  // it was not for us
    kRequest,  // the description is to be sent
    kCommand,
};

template <class Packets>
class ControllerSession {
  public:
    using State = typename Packets::State;
    using Command = typename Packets::Command;

    // `description` says what the controller is; its watchdog is in force unless a host wants another one.
    // A host that understands a handle is told of it, too.
    explicit ControllerSession(const Describe& description, const Handle& handle = {}) noexcept;

    Taken take(std::span<const std::byte> bytes, const Endpoint& source, int64_t now_ns) noexcept;

    // One period: `device_faults` (Fault bits) are those that the controller knows of now; silence and
    // lateness of the host are added here. `is_powered`: the motors could be switched on.
    void step(uint32_t device_faults, bool is_powered, int64_t now_ns) noexcept;

    // The command that the motors shall follow; null when they shall be damped, which is whenever anything
    // speaks against force.
    const Command* commandInForce(int64_t now_ns) const noexcept;
    // The newest command of this session; zero before the first. For what moves no motor.
    const Command& newestCommand() const noexcept { return command_; }

    // Complete packets for sending. The caller has filled in a state's inputs, mode and measurements.
    std::span<const std::byte> sealDescription() noexcept;  // good until the next call
    void seal(State& state, int64_t now_ns) noexcept;

    bool hasHost() const noexcept { return has_host_; }
    const Endpoint& host() const noexcept { return host_; }
    const DriveStateMachine& drive() const noexcept { return drive_; }
    const FlowStatistics& statistics() const noexcept { return flow_.statistics(); }
    uint64_t watchdogTrips() const noexcept { return watchdog_trips_; }

  private:
    Taken takeRequest(std::span<const std::byte> bytes, const Endpoint& source, int64_t now_ns) noexcept;
    Taken takeCommand(std::span<const std::byte> bytes, const Endpoint& source, int64_t now_ns) noexcept;
    void adopt(const DescribeRequest& request, const Endpoint& source, int64_t now_ns) noexcept;
    bool isSilent(int64_t now_ns) const noexcept;
    uint32_t linkFaults(int64_t now_ns) const noexcept;

    Describe description_;
    Handle handle_;
    Description long_description_{};
    uint32_t understands_ = 0;  // the host, in this session
    uint32_t own_watchdog_us_;
    uint32_t sequence_ = 0;  // of the newest packet sent; it goes on from session to session
    bool has_host_ = false;
    Endpoint host_;
    uint32_t session_ = 0;
    int64_t heard_ns_ = 0;  // from the host
    bool has_command_ = false;
    Command command_{};
    uint64_t lost_before_ = 0;  // commands, when the session began
    uint64_t watchdog_trips_ = 0;
    DriveStateMachine drive_;
    PacketFlow flow_;
};

extern template class ControllerSession<JointPackets>;
extern template class ControllerSession<PosePackets>;

// This is a ControllerSession on its socket. Making one throws UserError. Afterwards everything is RT-safe
// but for the socket's system calls.
template <class Packets>
class ControllerLink {
  public:
    using State = typename Packets::State;
    using Command = typename Packets::Command;

    // With `only_host`, no other sender is ever listened to.
    ControllerLink(const Describe& description, const Endpoint& local,
                   const std::optional<Endpoint>& only_host = {}, const Handle& handle = {})
        : socket_(local), session_(description, handle), only_host_(only_host) {
        keepStrangersOut();
    }

    // Takes what has come, without waiting, and answers requests. True says that a command was among it.
    bool poll(int64_t now_ns) noexcept;
    // Sleeps until something has come, or until the deadline, and takes it. True says that a command was
    // among it.
    bool waitForCommand(int64_t deadline_ns) noexcept;
    // Completes a state and sends it to the host, if there is one.
    bool send(State& state, int64_t now_ns) noexcept;

    ControllerSession<Packets>& session() noexcept { return session_; }
    const ControllerSession<Packets>& session() const noexcept { return session_; }
    Endpoint local() const noexcept { return socket_.local(); }

  private:
    void keepStrangersOut() noexcept;

    UdpSocket socket_;
    ControllerSession<Packets> session_;
    const std::optional<Endpoint> only_host_;
    std::optional<Endpoint> admitted_;  // the only one that the kernel lets in, if there is one
};

extern template class ControllerLink<JointPackets>;
extern template class ControllerLink<PosePackets>;

}  // namespace bonemill::wire

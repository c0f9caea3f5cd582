// This is a ControllerSession on its socket.
//
// Making one throws UserError. Afterwards everything is RT-safe but for the socket's system calls; one thread
// uses it.
#pragma once

#include "device_daemon/ares/wire/controller_session.h"
#include "device_daemon/ares/wire/udp_socket.h"

namespace bonemill::wire {

template <class Packets>
class ControllerLink {
  public:
    using State = typename Packets::State;
    using Command = typename Packets::Command;

    // With `only_host`, no other sender is ever listened to.
    ControllerLink(const Describe& description, const Endpoint& local,
                   const std::optional<Endpoint>& only_host = {})
        : socket_(local), session_(description), only_host_(only_host) {
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

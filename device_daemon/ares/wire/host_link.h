// This is a HostSession on its socket. Only its controller gets a packet into that, so that a flood of
// others keeps no state out.
//
// Making one throws UserError. Afterwards everything is RT-safe but for the socket's system calls; one thread
// uses it.
#pragma once

#include <utility>

#include "device_daemon/ares/wire/host_session.h"
#include "device_daemon/ares/wire/udp_socket.h"

namespace bonemill::wire {

// Returns a seed for session numbers that cannot be guessed.
uint64_t randomSeed();

template <class Packets>
class HostLink {
  public:
    using State = typename Packets::State;
    using Command = typename Packets::Command;

    // `local` is the address and port that the host sends from.
    HostLink(const HostSessionConfig& config, const Endpoint& local) : HostLink(config, UdpSocket(local)) {}
    // The same with a socket that is there already.
    HostLink(const HostSessionConfig& config, UdpSocket socket)
        : socket_(std::move(socket)), session_(config) {
        socket_.admitOnly(config.controller);
    }

    // Sleeps until a new state has come, or until the deadline; asks for the description meanwhile. True says
    // that a state has come.
    bool waitForState(int64_t deadline_ns) noexcept;
    // Takes what has come, without waiting, and asks if that is due. True says that a state was among it.
    bool poll(int64_t now_ns) noexcept;
    // Sends a command; all but its header, reflected sequence and time is the caller's.
    bool send(Command& command, int64_t now_ns) noexcept;

    const HostSession<Packets>& session() const noexcept { return session_; }
    Endpoint local() const noexcept { return socket_.local(); }

  private:
    UdpSocket socket_;
    HostSession<Packets> session_;
};

extern template class HostLink<JointPackets>;
extern template class HostLink<PosePackets>;

}  // namespace bonemill::wire

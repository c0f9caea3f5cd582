// This is the host's side of the wire, without a socket and without a clock: it asks a controller for its
// description, believes what that controller then says, and makes the commands that answer it.
//
// A session has a random number and lasts until the controller is silent for longer than the watchdog, or
// describes itself as another than before; then the host asks again under another number, for ever. Times are
// CLOCK_MONOTONIC ns. It is RT-safe after construction, for one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "common/base/units.h"
#include "device_daemon/ares/wire/packet_flow.h"
#include "device_daemon/ares/wire/packets.h"
#include "device_daemon/ares/wire/udp_socket.h"

namespace bonemill::wire {

inline constexpr int64_t kAskEveryNs = 100 * kNsPerMillisecond;

struct HostSessionConfig {
    Endpoint controller;
    uint32_t watchdog_us = 0;  // that the host asks for; 0: the controller's own
    uint64_t seed = 0;         // of the session numbers; it should differ from run to run
};

template <class Packets>
class HostSession {
  public:
    using State = typename Packets::State;
    using Command = typename Packets::Command;

    explicit HostSession(const HostSessionConfig& config) noexcept;

    // Takes a datagram. True says that it was a new state.
    bool take(std::span<const std::byte> bytes, const Endpoint& source, int64_t now_ns) noexcept;

    // Returns the question that is to be sent now, or null. It is called in every period, once what has come
    // was taken: here a link that is lost begins to ask again.
    const DescribeRequest* requestDue(int64_t now_ns) noexcept;

    // Completes a command (header, reflected sequence, host's time) for sending. False, before a description
    // has come, says that there is no peer to send it to.
    bool seal(Command& command, int64_t now_ns) noexcept;

    // The controller has described itself in this session.
    bool isDescribed() const noexcept { return is_described_; }
    // The field for which the newest description was refused; null: none was.
    const char* refusedFigure() const noexcept { return refused_figure_; }
    // It is silent for longer than the watchdog, or there is none.
    bool isLost(int64_t now_ns) const noexcept;
    // Both directions have proved themselves in this session.
    bool isTrusted() const noexcept { return is_described_ && flow_.isTrusted(); }
    bool tooManyLate() const noexcept { return is_described_ && flow_.tooManyLate(); }

    // The newest state, of this session or an earlier one; zero before the first.
    const State& state() const noexcept { return state_; }
    // The same of descriptions, whose count tells when there is another one.
    const Describe& description() const noexcept { return description_; }
    uint32_t descriptionCount() const noexcept { return description_count_; }
    // So many states of its own were whole, but their numbers were none: who sends such is not to be
    // believed.
    uint32_t nonsenseCount() const noexcept { return nonsense_count_; }
    // It came with that description; zero where the controller did not say.
    const Handle& handle() const noexcept { return handle_; }
    // True if a state has come in this session.
    bool hasState() const noexcept { return has_state_; }

    const Endpoint& controller() const noexcept { return config_.controller; }
    const FlowStatistics& statistics() const noexcept { return flow_.statistics(); }

  private:
    bool takeState(std::span<const std::byte> bytes, int64_t now_ns) noexcept;
    void takeDescription(std::span<const std::byte> bytes, int64_t now_ns) noexcept;
    void beginToAsk() noexcept;
    uint32_t nextSessionNumber() noexcept;

    HostSessionConfig config_;
    uint64_t random_;
    uint32_t session_ = 0;
    uint32_t sequence_ = 0;          // of the newest packet sent
    uint32_t request_sequence_ = 0;  // of the session's first request
    int64_t ask_at_ns_ = 0;
    DescribeRequest request_{};
    bool is_described_ = false;
    bool has_state_ = false;
    const char* refused_figure_ = nullptr;  // a literal
    uint32_t description_count_ = 0;
    uint32_t nonsense_count_ = 0;
    Describe description_{};
    Handle handle_{};
    State state_{};
    PacketFlow flow_;
};

extern template class HostSession<JointPackets>;
extern template class HostSession<PosePackets>;

// Returns a seed for session numbers that cannot be guessed.
uint64_t randomSeed();

// This is a HostSession on its socket. Only its controller gets a packet into that, so that a flood of
// others keeps no state out. Making one throws UserError. Afterwards everything is RT-safe but for the
// socket's system calls.
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

// This is one direction of a bad wire: what goes in comes out late, twice, changed, or not at all.
//
// Times are CLOCK_MONOTONIC ns. It is RT-safe after construction, for one thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "device_daemon/ares/emulator/fault_spec.h"
#include "device_daemon/ares/wire/packets.h"
#include "device_daemon/ares/wire/udp_socket.h"

namespace bonemill {

class FaultyWire {
  public:
    struct Datagram {
        int64_t due_ns = 0;
        wire::Endpoint other;  // who sent it, or gets it
        size_t size = 0;
        std::array<std::byte, wire::kMaxPacket> bytes{};

        std::span<const std::byte> content() const noexcept { return std::span(bytes).first(size); }
    };

    // Faults that are not of packets are ignored.
    FaultyWire(const std::vector<FaultSpec>& faults, uint32_t seed, int64_t period_ns);

    // A datagram, of kMaxPacket bytes at most, enters the wire.
    void put(std::span<const std::byte> bytes, const wire::Endpoint& other, double engaged_s,
             int64_t now_ns) noexcept;
    // Takes the next one that is due out of the wire. False says that there is none now.
    bool take(Datagram& datagram, int64_t now_ns) noexcept;
    // When the next one is due; the largest number when the wire is empty.
    int64_t nextDueNs() const noexcept;

  private:
    bool happens(const FaultSpec& fault, double engaged_s) noexcept;
    void enter(std::span<const std::byte> bytes, const wire::Endpoint& other, int64_t due_ns) noexcept;
    Datagram* firstDue() noexcept;

    std::vector<FaultSpec> faults_;
    std::mt19937 random_;
    int64_t period_ns_;
    std::vector<Datagram> under_way_;  // it never grows: a full wire loses datagrams
    size_t count_ = 0;
};

}  // namespace bonemill

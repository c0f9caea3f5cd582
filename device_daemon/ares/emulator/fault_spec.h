// This is a fault that the emulator is told to have, as `--fault` says it, and the wire that has it.
//
// Reading one allocates and throws UserError; the rest is RT-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "device_daemon/ares/wire/packets.h"
#include "device_daemon/ares/wire/udp_socket.h"

namespace bonemill {

enum class FaultKind {
    // These befall single packets, in both directions.
    kDrop,
    kDelay,
    kDuplicate,
    kReorder,
    kCorrupt,
    kUnplug,
    // These befall the device.
    kStuckEncoder,
    kEncoderOffset,
    kDeadAmplifier,
    kEmergencyStop,
    kOverTemperature,
};

struct FaultSpec {
    FaultKind kind = FaultKind::kDrop;
    int axis = 0;                 // 0 to 5
    double offset = 0;            // m, of kEncoderOffset
    double delay = 0;             // s, of kDelay
    std::optional<double> start;  // s since the hand was engaged first; not given: from the beginning
    double duration = std::numeric_limits<double>::infinity();  // s
    double chance = 1;                                          // of each packet

    // `engaged_s` is the time since the hand was engaged first; negative before.
    bool isActive(double engaged_s) const noexcept {
        return !start || (engaged_s >= *start && engaged_s < *start + duration);
    }
    bool isOfPackets() const noexcept { return kind <= FaultKind::kUnplug; }
};

// Reads "KIND[:ARGUMENT...][@START_S[+DURATION_S]][%PERCENT]".
FaultSpec faultSpecOf(const std::string& text);

// Explains the kinds to users, one line each.
std::string faultHelp();

// This is one direction of a bad wire: what goes in comes out late, twice, changed, or not at all. Times are
// CLOCK_MONOTONIC ns. It is RT-safe after construction, for one thread.
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

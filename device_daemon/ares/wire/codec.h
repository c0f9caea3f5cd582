// This makes bytes of packets and packets of bytes. What comes in is believed only when it is well-formed.
//
// It is RT-safe, and any thread may call it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "device_daemon/ares/wire/packets.h"

namespace bonemill::wire {

// These are the packets of the two kinds of device.
struct JointPackets {
    using State = JointState;
    using Command = JointCommand;
};
struct PosePackets {
    using State = PoseState;
    using Command = PoseCommand;
};

// Fills in header and CRC, after everything else.
template <class Packet>
void seal(Packet& packet, uint32_t session, uint32_t sequence) noexcept;

// Returns the packet if the bytes are exactly one of this type: length, magic, version, type and CRC are
// right, every number is finite (but for those that may be missing as NaN, all of them at once), and text
// ends.
template <class Packet>
std::optional<Packet> open(std::span<const std::byte> bytes) noexcept;

// Returns the type that the header claims; nothing if there is no header of ours.
std::optional<PacketType> claimedType(std::span<const std::byte> bytes) noexcept;

template <class Packet>
std::span<const std::byte> bytesOf(const Packet& packet) noexcept {
    return std::as_bytes(std::span<const Packet, 1>(&packet, 1));
}

// Tells whether this sequence number is the newer one: ahead by 1 to 2^31 - 1, modulo 2^32.
constexpr bool isNewer(uint32_t sequence, uint32_t than) noexcept {
    return sequence != than && sequence - than < 0x80000000u;
}

}  // namespace bonemill::wire

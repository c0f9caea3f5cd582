// The side of TCP that is reached. The sockets do not block, and other programs do not inherit them.
#pragma once

#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/tcp/descriptor.h"

namespace bonemill {

// Who is at the other end of a TCP line, without the port: what connections are counted by. An IPv6 address
// in network order; that of IPv4 is mapped into it (::ffff:a.b.c.d, RFC 4291, 2.5.5.2).
using PeerAddress = std::array<char, 16>;

PeerAddress peerAddressOf(const sockaddr_storage& address);
// Returns "192.0.2.1" or "2001:db8::1".
std::string textOf(const PeerAddress& address);
// It is an address of the loopback: nobody but this PC's programs is there.
bool isLoopback(std::string_view address);

// Listens there; port 0: any. Throws UserError.
Descriptor listenOn(const std::string& address, uint16_t port);
uint16_t portOf(int socket);
// Returns who came next and from where; nothing when no peer waits, or no descriptor is left.
Descriptor acceptFrom(int listener, PeerAddress& from);
// Takes N descriptors, or as many as this user may have; returns how many that are.
size_t allowDescriptors(size_t count);

}  // namespace bonemill

// Who is at the other end of a TCP line, without the port: what connections are counted by. The functions are
// thread-safe.
#pragma once

#include <sys/socket.h>

#include <array>
#include <string>

namespace bonemill {

// An IPv6 address in network order; that of IPv4 is mapped into it (::ffff:a.b.c.d, RFC 4291, 2.5.5.2).
using PeerAddress = std::array<char, 16>;

PeerAddress peerAddressOf(const sockaddr_storage& address);
// Returns "192.0.2.1" or "2001:db8::1".
std::string textOf(const PeerAddress& address);

}  // namespace bonemill

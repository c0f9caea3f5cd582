// The side of TCP that is reached. The sockets do not block, and other programs do not inherit them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "common/tcp/descriptor.h"
#include "common/tcp/peer_address.h"

namespace bonemill {

// Listens there; port 0: any. Throws UserError.
Descriptor listenOn(const std::string& address, uint16_t port);
uint16_t portOf(int socket);
// Returns who came next and from where; nothing when no peer waits, or no descriptor is left.
Descriptor acceptFrom(int listener, PeerAddress& from);
// Takes N descriptors, or as many as this user may have; returns how many that are.
size_t allowDescriptors(size_t count);

}  // namespace bonemill

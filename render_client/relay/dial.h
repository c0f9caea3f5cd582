// TCP sockets of relay and gateway: none of them blocks, and none is inherited by other programs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "render_client/relay/descriptor.h"

namespace bonemill {

// Listens there; port 0: any. Throws UserError.
Descriptor listenOn(const std::string& address, uint16_t port);
uint16_t portOf(int socket);
// Returns who came next and from where; nothing when nobody waits, or no descriptor is left.
Descriptor acceptFrom(int listener, std::string& address);
// Begins to connect: the socket can be written to when it is done, or has an error then. Nothing if the host
// has no address. Waits for the name's address.
Descriptor beginDial(const std::string& host, uint16_t port);
// Takes so many descriptors, or as many as this user may have; returns how many that are.
size_t allowDescriptors(size_t count);

}  // namespace bonemill

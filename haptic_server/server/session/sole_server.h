// What a server asks of the network before it shows anything. It is for start-up only.
#pragma once

#include <cstdint>

#include "common/dds/network.h"
#include "haptic_server/server/publish/publisher.h"

namespace bonemill {

// Joins the domain for a moment. Throws UserError if the session has a server already; says in the log if
// anyone in the network can join in.
PublisherOptions soleServerOf(uint32_t domain, uint32_t session, const dds::NetworkOptions& network);

}  // namespace bonemill

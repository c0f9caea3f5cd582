// Finds a server that a session has already, anywhere in the network: two of them would show every viewer
// now one bone and now the other. (On one PC the shared memory refuses the second.) It is not for the tick.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "common/dds/network.h"
#include "common/dds/participant.h"
#include "haptic_server/server/publish/publisher.h"

namespace bonemill {

struct OtherServer {
    std::string scene;      // as it calls it
    uint64_t epoch_ns = 0;  // unix time of its start
};

// Listens for so long; returns at once when it has heard one. Both ends must have had that time to find each
// other. Nothing else is in this session of the participant yet.
std::optional<OtherServer> findOtherServer(const dds::Participant& participant, uint32_t session,
                                           std::chrono::milliseconds patience);

// Returns what another process calls a thing, as it may stand in a log: printable, and not long.
std::string printableName(std::string name);

// Says who has the session, since when, and what to do.
std::string refusalText(const OtherServer& other, uint32_t domain, uint32_t session);

// What a server asks of the network before it shows anything: joins the domain for a moment. Throws UserError
// if the session has a server already; says in the log if anyone in the network can join in.
PublisherOptions soleServerOf(uint32_t domain, uint32_t session, const dds::NetworkOptions& network);

}  // namespace bonemill

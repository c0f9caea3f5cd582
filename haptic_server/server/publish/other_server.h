// Finds a server that a session has already, anywhere in the network: two of them would show every viewer
// now one bone and now the other. (On one PC the shared memory refuses the second.) It is not for the tick.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "common/dds/participant.h"

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

}  // namespace bonemill

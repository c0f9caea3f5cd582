// Chooses the network that this process joins: a profile of deploy/dds, this PC's interface, peers
// (docs/network.md). It is not for the tick.
#pragma once

#include <string>
#include <vector>

namespace bonemill::dds {

struct NetworkOptions {
    std::string profile = {};    // one-pc, lab, classroom or a file of Cyclone DDS; empty: the default
    std::string interface = {};  // of this PC, name or IPv4 address: what ${BONEMILL_ADDRESS} stands for
    std::vector<std::string> peers = {};  // PCs to look for, names or IPv4 addresses; given: no multicast
};

// This PC is one of several with the profile lab or classroom.
bool isLanProfile(const std::string& profile);

// Makes Cyclone's configuration: one or more XML fragments. It is empty when CYCLONEDDS_URI says it
// all. Throws UserError.
std::string networkConfiguration(const NetworkOptions& options);

// From now on every participant of this process joins this network; without a call, that of NetworkOptions().
// It is called before the first participant, by one thread. Throws UserError.
void setNetwork(const NetworkOptions& options);

}  // namespace bonemill::dds

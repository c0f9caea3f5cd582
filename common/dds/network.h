// Chooses the network that this process joins: a profile of deploy/dds, this PC's interface, peers
// (docs/howto/network.md). It is not for the tick.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/security/certificate.h"

namespace bonemill::dds {

struct NetworkInterface {
    std::string name;
    std::string address;  // IPv4, dotted
    bool is_up = false;
};

// Lists those of this PC with an IPv4 address, without the loopback; there is one entry per address.
std::vector<NetworkInterface> networkInterfaces();

// Writes them as "eth0 (192.168.1.5), wlan0 (10.0.0.3, down)".
std::string textOf(const std::vector<NetworkInterface>& interfaces);

struct NetworkOptions {
    std::string profile = {};    // one-pc, lab, classroom or a file of Cyclone DDS; empty: the default
    std::string interface = {};  // of this PC, name or IPv4 address: what ${BONEMILL_ADDRESS} stands for
    std::vector<std::string> peers = {};  // PCs to look for, names or IPv4 addresses; given: no multicast
    std::string secure = {};              // folder of deploy/security/make-session; empty: no DDS Security
};

// What a program is in a session: --secure takes only folders that were made for it.
enum class NetworkPart { kServer, kDevice, kViewer };

// This PC is one of several with the profile lab or classroom.
bool isLanProfile(const std::string& profile);

// Whoever is in this network can join: it is more than this PC, and nothing is secured.
bool isOpenToOthers(const NetworkOptions& options);

// Returns whose folder --secure names; nothing without it. Throws UserError when it is not in order.
std::optional<Identity> identityOf(const NetworkOptions& options);

// Makes Cyclone's configuration: one or more XML fragments. It is empty when CYCLONEDDS_URI says it
// all. Throws UserError.
std::string networkConfiguration(const NetworkOptions& options);

// The configuration is that of profile one-pc: no other PC is heard.
bool isOnePc(const std::string& configuration);

// From now on every participant of this process joins this network; without a call, that of NetworkOptions().
// It is called before the first participant, by one thread. Throws UserError, also when the folder of
// --secure is not this program's, or was made for another session than `session`, or is not in order. A
// program that is of no session in particular gives none.
void setNetwork(const NetworkOptions& options, NetworkPart part = NetworkPart::kViewer,
                std::optional<uint32_t> session = std::nullopt);

}  // namespace bonemill::dds

// What the gateway is to do (render_client --serve).
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render_client/link/subscribe/heard_peers.h"
#include "render_client/web/relay/relay_greeting.h"

namespace bonemill::gateway {

inline constexpr uint32_t kMaxGuestsOfGateway = 1000;

struct GatewayOptions {
    uint32_t domain = 0;   // DDS
    uint32_t session = 1;  // of the server
    std::string address = "127.0.0.1";
    uint16_t port = 0;                  // 0: any that is free
    std::filesystem::path certificate;  // PEM; empty: one of its own making
    std::filesystem::path key;          // PEM
    std::vector<std::string> names;     // of hosts, besides the certificate's, that are this gateway's
    std::filesystem::path guests;       // empty: in the user's configuration
    std::filesystem::path page;         // folder of the page
    double guest_mbit_per_s = 20;       // at most, to each guest
    uint32_t most_guests = 64;          // kMaxGuestsOfGateway at most
    std::optional<RelayPlace> via;      // guests come through this relay, too
    // After so much silence in DDS it joins anew (SilenceMonitor).
    std::chrono::milliseconds rejoin_after = SilenceMonitor::kFirstSilence;
};

}  // namespace bonemill::gateway

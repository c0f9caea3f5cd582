// What the gateway is to do (render_client --serve).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace bonemill::gateway {

struct GatewayOptions {
    uint32_t domain = 0;   // DDS
    uint32_t session = 1;  // of the server
    std::string address = "127.0.0.1";
    uint16_t port = 0;                  // 0: any that is free
    std::filesystem::path certificate;  // PEM; empty: one of its own making
    std::filesystem::path key;          // PEM
    std::filesystem::path guests;       // empty: in the user's configuration
    std::filesystem::path page;         // folder of the page
    double guest_mbit_per_s = 20;       // at most, to each guest
};

}  // namespace bonemill::gateway

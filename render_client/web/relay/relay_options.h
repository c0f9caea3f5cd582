// What a relay is to do (render_client --relay), and what a gateway must know of its relay (--via).
#pragma once

#include <cstdint>
#include <string>

namespace bonemill {

struct RelayOptions {
    std::string address = "127.0.0.1";  // it listens there
    uint16_t port = 0;                  // 0: any
    std::string secret;                 // shared with the gateway
};

struct RelayPlace {
    std::string host;
    uint16_t port = 0;
    std::string secret;
};

}  // namespace bonemill

// Reads the command line that all bridges share.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace bonemill::bridge {

struct BridgeOptions {
    std::string address = "127.0.0.1";
    uint16_t port = 0;                // 0: any free one
    uint16_t host_port = 0;           // of this PC, the only one that is listened to; 0: any host
    std::string library;              // empty: search
    std::string device;               // number or name; empty: the first
    std::optional<double> max_force;  // N; not given: the arm's own
    bool probe = false;
    bool self_test = false;
    bool ramp = false;
    double seconds = 5;  // of the self-test
    bool is_strict_realtime = false;
    int core = -1;
    std::optional<int> parent;  // process to end with
};

// `about` says what the program is; `add` adds the options of one bridge alone. Returns nothing after --help,
// which is already printed. Throws UserError.
std::optional<BridgeOptions> parseBridgeOptions(int argc, char** argv, const std::string& about,
                                                const std::function<void(CLI::App&)>& add = {});

}  // namespace bonemill::bridge

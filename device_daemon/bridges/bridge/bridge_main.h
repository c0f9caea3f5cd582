// Every bridge's main(): options, signals, the arm's life, and a way out that takes the force away and ends
// in time whatever the vendor's library does.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/rt/realtime.h"
#include "device_daemon/bridges/bridge/arm.h"

namespace bonemill::bridge {

// The command line that all bridges share.
struct BridgeOptions {
    std::string address = "127.0.0.1";
    uint16_t port = 0;                // 0: any free one
    uint16_t host_port = 0;           // of this PC, the only one that is listened to; 0: any host
    std::string library;              // empty: search
    std::string device;               // number or name; empty: the first
    std::optional<double> max_force;  // N; not given: the arm's own
    // Of the handle, in the arm's place; not given: what the arm says.
    std::optional<double> mass, damping, delay_ms, encoder_step_um;  // kg, N·s/m
    bool probe = false;
    bool self_test = false;
    bool ramp = false;
    double seconds = 5;  // of the self-test
    bool is_strict_realtime = false;
    int core = -1;
    std::optional<int> parent;  // process to end with
};

// Starts the real-time thread of an arm whose library has no clock of its own; `tell` gets what the machine
// does not grant. Throws UserError when that is too little.
inline RealtimeThread startArmLoop(const BridgeOptions& options, const Tell& tell,
                                   std::function<void()> loop) {
    return RealtimeThread({{.core = options.core}, options.is_strict_realtime, "the arm's loop"},
                          std::move(loop), [&tell](const RealtimeReport& report) {
                              for (const std::string& missing : report.missing) tell(missing);
                          });
}

struct BridgeProgram {
    std::string about;                                // what the program is
    std::function<void(CLI::App&)> add_options = {};  // of this bridge alone
    std::function<std::unique_ptr<Arm>(const BridgeOptions&)> make_arm;
};

// Returns the exit code: 0 left in order, 1 the arm was lost or hung, 2 wrong input or no arm, 3 the library
// did not return in time.
int runBridge(int argc, char** argv, const BridgeProgram& program);

}  // namespace bonemill::bridge

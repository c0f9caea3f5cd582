// Every bridge's main(): options, signals, the arm's life, and a way out that takes the force away and ends
// in time whatever the vendor's library does.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/bridge_options.h"

namespace bonemill::bridge {

struct BridgeProgram {
    std::string about;
    std::function<void(CLI::App&)> add_options = {};  // of this bridge alone
    std::function<std::unique_ptr<Arm>(const BridgeOptions&)> make_arm;
};

// Returns the exit code: 0 left in order, 1 the arm was lost or hung, 2 wrong input or no arm, 3
// (kStuckExitCode) the library did not return in time.
int runBridge(int argc, char** argv, const BridgeProgram& program);

}  // namespace bonemill::bridge

// The real-time thread of an arm whose library has no clock of its own.
#pragma once

#include <functional>

#include "common/rt/realtime_thread.h"
#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/bridge_options.h"

namespace bonemill::bridge {

// Starts it; `tell` gets what the machine does not grant. Throws UserError when that is too little.
inline RealtimeThread startArmLoop(const BridgeOptions& options, const Tell& tell,
                                   std::function<void()> loop) {
    return RealtimeThread({{.core = options.core}, options.is_strict_realtime, "the arm's loop"},
                          std::move(loop), [&tell](const RealtimeReport& report) {
                              for (const std::string& missing : report.missing) tell(missing);
                          });
}

}  // namespace bonemill::bridge

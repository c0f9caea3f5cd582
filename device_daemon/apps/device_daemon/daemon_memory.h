// What goes on from one scene's daemon to the next one's.
#pragma once

#include <optional>

#include "common/ipc/device_link.h"
#include "common/rt/clock.h"
#include "device_daemon/apps/device_daemon/loop_statistics.h"
#include "device_daemon/control/safety/safety_states.h"

namespace bonemill {

struct DaemonMemory {
    LoopStatistics statistics;
    SafetyLatch stop;                         // a stop holds until a user resets the device
    std::optional<DeviceSample> last_sample;  // that went out; nothing before the first and after a goodbye
};

// Lets haptic_server tell an orderly end from a fault. RT-safe.
inline void sayGoodbye(DeviceLink& link, DaemonMemory& memory) noexcept {
    if (!memory.last_sample) return;
    memory.last_sample->stamp_ns = monotonicNowNs();
    memory.last_sample->flags |= kDeviceFlagLeaving;
    link.writeSample(*memory.last_sample);
    memory.last_sample.reset();
}

}  // namespace bonemill

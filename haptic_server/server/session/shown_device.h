// This is what clients are shown of the device. It is for any normal thread.
#pragma once

#include "haptic_server/core/telemetry/tick_record.h"
#include "proto/topics.pb.h"

namespace bonemill {

// `capabilities` is null as long as no device has told of itself.
topics::Device shownDevice(const TickRecord& record, const DeviceCapabilities* capabilities);

// Says what the session adapts to: "Touch: 3.3 N, no torque".
std::string deviceText(const DeviceCapabilities& capabilities);

}  // namespace bonemill

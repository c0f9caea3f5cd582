// A task divides the scanned bone into zones: what shall go, what may, what must stay.
//
// They are plain values.
#pragma once

#include <cstdint>
#include <string>

namespace bonemill {

// In the order of scene.Task.Role.
enum class ZoneRole : uint8_t {
    kTarget,
    kLeewaySides,
    kLeewayBottom,
    kContainerSides,
    kContainerBottom,
    kProtected,
    kContext
};

struct Zone {
    std::string name;
    ZoneRole role = ZoneRole::kContext;
};

using ZoneId = uint8_t;  // 1 + index in the task's list; 0: of no zone
inline constexpr ZoneId kNoZone = 0;

}  // namespace bonemill

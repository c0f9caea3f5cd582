// A task divides the scanned bone into zones: what shall go, what may, what must stay.
//
// Reading is for any thread. Nothing here belongs to the tick.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "haptic_server/volume/brick_map.h"

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

// Says of which zone a voxel is. Memory goes to bricks that hold something of one.
class ZoneMap {
  public:
    // `ids` has one of each voxel, x fastest. It allocates.
    ZoneMap(const Eigen::Vector3i& dims, const std::vector<ZoneId>& ids);

    const Eigen::Vector3i& dims() const noexcept { return map_.dims(); }
    ZoneId at(const Eigen::Vector3i& voxel) const noexcept {
        const size_t place = map_.find(voxel);
        return place == BrickMap::kNowhere ? kNoZone : ids_[place];
    }

  private:
    BrickMap map_;
    std::vector<ZoneId> ids_;
};

}  // namespace bonemill

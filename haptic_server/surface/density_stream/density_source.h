// The bone's densities brick by brick, as viewers get them: as scanned, and as they are now beside the tick.
//
// Bricks have kBrickVoxels³ voxels and are numbered x fastest; the last ones of an axis reach beyond the
// volume, with density 0 there. It is for one normal thread, never RT-safe; it only reads, and makes the tick
// wait for nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/core/bone/bone_history.h"
#include "haptic_server/core/volume/bone_properties.h"

namespace bonemill {

class DensitySource {
  public:
    static constexpr int kBrickVoxels = 16;

    // References, which must outlive this object, as must the properties; null: no viewer asks for materials.
    DensitySource(const BoneModel& bone, const BoneHistory& history,
                  const BoneProperties* properties = nullptr)
        : bone_(bone),
          scanned_(history.scanned()),
          properties_(properties),
          bricks_((scanned_.dims().array() + (kBrickVoxels - 1)) / kBrickVoxels) {}

    const VolumeGeometry& geometry() const { return scanned_.geometry(); }
    uint32_t brickCount() const { return uint32_t(bricks_.prod()); }

    std::vector<Density> scanned(uint32_t brick) const;
    // It is empty where no viewer asks for materials.
    std::vector<MaterialId> materials(uint32_t brick) const;
    // It has a bit per brick, the lowest of a byte first: scanned as air only.
    std::string airBits() const;

    // Counts up with whatever is written near the brick's voxels; 0: nothing ever was. Nothing is returned
    // while the tick is writing there.
    std::optional<uint32_t> revision(uint32_t brick) const;
    struct Present {
        uint32_t revision;
        std::vector<Density> densities;
    };
    // Nothing is returned if the tick wrote there each time that it was tried.
    std::optional<Present> present(uint32_t brick) const;

  private:
    IndexBox voxelsOf(uint32_t brick) const;
    bool isAir(uint32_t brick) const;
    std::vector<Density> presentNow(uint32_t brick) const;

    const BoneModel& bone_;
    const VoxelVolume& scanned_;
    const BoneProperties* properties_;
    Eigen::Vector3i bricks_;  // per axis
};

}  // namespace bonemill

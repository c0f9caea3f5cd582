// Makes a lumbar vertebra (L3) in Hounsfield units with the nerves and vessels around it: cortical shell
// over trabecular core, dural sac in the canal, the third lumbar nerve roots under the pedicles, aorta
// and segmental vessels.
//
// Lengths are in m. W has its origin in the middle of the vertebral body, x to the patient's left, y to
// the back, z up (LPS). Sizes are rounded from morphometry of L3 (Panjabi et al., Spine 17:299, 1992;
// Zindrick et al., Spine 12:160, 1987): body 45 x 33 x 28 mm, pedicles 10 mm wide and 14.5 mm high, canal
// 24 x 17 mm, 95 mm across the transverse processes; both sides are alike. docs/reference/phantoms.md
// describes shell and densities. Thread-safe; start-up only.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// The label volume holds these numbers.
enum class VertebraTissue : uint8_t {
    kFat,
    kCortical,
    kTrabecular,
    kDuralSac,
    kLeftRoot,
    kRightRoot,
    kVessel
};

struct VertebraKind {
    // How wide the pedicles are, but for what the seed changes: 10, 7.5 and 6 mm.
    enum class Pedicles : uint8_t { kWide, kMiddle, kNarrow };

    Pedicles pedicles = Pedicles::kWide;
    // An osteoporotic one has two thirds of the shell and of the density in its core.
    bool is_porous = false;
    // 0 has the sizes of the tables; another one differs from them by some percent. Axes of the pedicles,
    // canal, nerves and vessels are those of all.
    uint64_t seed = 0;
};

struct VertebraScan {
    RawVolume ct;                 // HU; edges are soft over 2.5 voxels, the scanner's blur
    std::vector<uint8_t> labels;  // VertebraTissue, x fastest; bone where the CT has kBoneHu or more
};

class VertebraShapes;

class Vertebra {
  public:
    explicit Vertebra(const VertebraKind& kind = {});
    ~Vertebra();

    // The grid holds the whole vertebra and what lies around it.
    VolumeGeometry grid(double voxel_size) const;
    // The same kind and geometry give the same values everywhere.
    VertebraScan scan(const VolumeGeometry& geometry) const;

    // This is the signed distance to the bone's surface in m, negative inside; it is exact to some 10 % near
    // the surface and a bound elsewhere.
    double distance(const Eigen::Vector3d& p_W) const noexcept;
    // It is the thickness of the shell there, in m.
    double corticalThickness(const Eigen::Vector3d& p_W) const noexcept;

  private:
    std::unique_ptr<const VertebraShapes> shapes_;
};

inline constexpr double kFatHu = -100, kSoftHu = 40;  // around, and of nerves and vessels
inline constexpr double kBoneHu = 100;                // the bone's surface
inline constexpr double kTrabecularLowHu = 160, kTrabecularHighHu = 390;

}  // namespace bonemill

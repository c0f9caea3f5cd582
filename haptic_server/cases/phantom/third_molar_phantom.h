// Makes a piece of a lower jaw with an impacted third molar in Hounsfield units: cortex over trabecular
// bone, a second molar, the third molar tilted forwards beneath the bone with its follicle, and the canal of
// the inferior alveolar nerve below its roots. No patient's: shapes and their variation are put together from
// textbook sizes (docs/reference/phantoms.md); another seed is another jaw.
//
// Lengths are in m. W is LPS: x to the patient's left, y to the back, z up; its origin is the middle of the
// bone's crest, right behind the second molar. A right jaw is the mirror image, in x, of the left one of the
// same kind. Thread-safe; start-up only.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// The label volume holds these numbers.
enum class MolarTissue : uint8_t {
    kNone,  // bone, air and soft tissue
    kNerve,
    kEnamel,  // of the third molar, as are dentine and pulp
    kDentine,
    kPulp,
    kSecondMolar,
    kLingualPlate  // the bone on the tongue's side
};

struct ThirdMolarKind {
    // How deep the highest place of the crown lies below the crest: -0.7, 1.5 and 4 mm.
    enum class Impaction : uint8_t { kShallow, kMiddle, kDeep };
    // How far the nerve is from the roots: 3, 1.2 and 0.3 mm.
    enum class Nerve : uint8_t { kFar, kNear, kTouching };

    bool is_right = false;
    Impaction impaction = Impaction::kShallow;
    Nerve nerve = Nerve::kFar;
    uint64_t seed = 1;
};

struct MolarScan {
    RawVolume ct;                 // HU; edges are soft over 2.5 voxels, the scanner's blur
    std::vector<uint8_t> labels;  // MolarTissue, x fastest
};

class MolarShapes;

class ThirdMolar {
  public:
    explicit ThirdMolar(const ThirdMolarKind& kind);
    ~ThirdMolar();

    // The grid holds the whole piece and a margin of air.
    VolumeGeometry grid(double voxel_size) const;
    // The same kind and geometry give the same values everywhere.
    MolarScan scan(const VolumeGeometry& geometry) const;

    // These are signed distances to surfaces in m, negative inside; exact to some 20 % near them.
    double nerveDistance(const Eigen::Vector3d& p_W) const noexcept;
    double thirdMolarDistance(const Eigen::Vector3d& p_W) const noexcept;
    double secondMolarDistance(const Eigen::Vector3d& p_W) const noexcept;
    double jawDistance(const Eigen::Vector3d& p_W) const noexcept;  // as if there were no teeth in it

  private:
    ThirdMolarKind kind_;
    std::unique_ptr<const MolarShapes> shapes_;
};

}  // namespace bonemill

// Makes the mastoid part of a temporal bone in Hounsfield units, as a block cut from a skull: cortex, air
// cells, antrum, middle ear with ossicles, ear canal, inner ear in its dense capsule, facial nerve, sigmoid
// sinus with jugular bulb, and the dura of both fossae. No patient's: shapes and their variation are put
// together from published sizes (docs/reference/phantoms.md names them); another seed is another bone.
//
// Lengths are in m. W is LPS: x to the patient's left, y to the back, z up; its origin is the spine of
// Henle. A right bone is the mirror image, in x, of the left one of the same kind. Thread-safe; start-up
// only.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// The label volume holds these numbers.
enum class TemporalTissue : uint8_t {
    kNone,  // bone, air and soft tissue
    kSigmoidSinus,
    kFacialNerve,
    kDura,
    kSemicircularCanals,
    kOssicles
};

struct TemporalBoneKind {
    enum class Pneumatisation : uint8_t { kWell, kPoor, kSclerotic };

    bool is_right = false;
    Pneumatisation pneumatisation = Pneumatisation::kWell;
    bool has_high_jugular = false;  // the bulb's dome lies 4 mm higher
    bool has_low_dura = false;      // the mastoid's tegmen lies 3 mm lower
    uint64_t seed = 1;
};

struct TemporalScan {
    RawVolume ct;                 // HU; edges are soft over 2.5 voxels, the scanner's blur
    std::vector<uint8_t> labels;  // TemporalTissue, x fastest
};

class TemporalShapes;
class AirCells;

class TemporalBone {
  public:
    explicit TemporalBone(const TemporalBoneKind& kind);
    ~TemporalBone();

    // The grid holds the whole block and a margin of air.
    VolumeGeometry grid(double voxel_size) const;
    // The same kind and geometry give the same values everywhere.
    TemporalScan scan(const VolumeGeometry& geometry) const;

    // This is the signed distance to a structure's surface in m, negative inside; exact to some 20 % near
    // it. kNone is not allowed.
    double distance(TemporalTissue tissue, const Eigen::Vector3d& p_W) const noexcept;
    // It is the number of the air cell of a place among cells (or in a wall beside that cell), else -1.
    int cellAt(const Eigen::Vector3d& p_W) const;

  private:
    TemporalBoneKind kind_;
    std::unique_ptr<const TemporalShapes> shapes_;
    std::unique_ptr<const AirCells> cells_;
};

}  // namespace bonemill

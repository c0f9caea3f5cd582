// Makes the anatomy of a temporal bone's mastoid part as signed distances: what bounds the bone, and the
// structures, spaces and canals in it.
//
// Everything is of a left ear, in mm: x to the side (lateral), y to the back, z up, Frankfurt plane level;
// the origin is the spine of Henle, at the upper back edge of the ear canal's opening. Distances are
// negative inside, exact to some 20 % within 4 mm of a surface. Thread-safe; building allocates,
// distances do not.
#pragma once

#include <array>

#include "haptic_server/cases/phantom/spline_shapes.h"
#include "haptic_server/cases/phantom/temporal_bone_phantom.h"

namespace bonemill {

enum class TemporalShape : uint8_t {
    kBlock,    // the specimen's saw cuts
    kOuter,    // bone, as if without the spaces within it and the cavity of the skull
    kCranium,  // middle and posterior fossa, up to the bone
    kSinus,    // sigmoid sinus, jugular bulb and vein
    kNerve,
    kCanals,    // semicircular canals
    kInnerEar,  // vestibule and cochlea
    kOssicles,
    kEarCanal,   // open to the side, up to the drum
    kDrum,       // tympanic membrane
    kMiddleEar,  // tympanic cavity and epitympanum
    kAntrum,     // with its aditus
    kCarotid,
    kMeatus,  // internal auditory canal
    kCount
};

inline constexpr size_t kTemporalShapes = size_t(TemporalShape::kCount);
using TemporalDistances = std::array<double, kTemporalShapes>;

// What differs from bone to bone; in mm, and the ranges in which the seed draws.
struct TemporalMeasures {
    explicit TemporalMeasures(const TemporalBoneKind& kind);

    double sinus_forward, sinus_deep, sinus_radius;
    double tegmen_up, bulb_up, tip_down;
    double nerve_back, nerve_radius;
    double canal_turn;  // rad, of the labyrinth about z
    double ear_canal_radius, antrum_size;
    double cortex, sinus_plate, tegmen_plate;  // mean thickness of bone over cells
    Eigen::Vector3d wave_phase;                // rad, of the surfaces' unevenness
    double low_dura;                           // how far the mastoid's tegmen hangs down
};

class TemporalShapes {
  public:
    explicit TemporalShapes(const TemporalBoneKind& kind);

    double distance(TemporalShape shape, const Eigen::Vector3d& p) const noexcept;
    TemporalDistances distances(const Eigen::Vector3d& p) const noexcept;
    // x of the outer surface beside the mastoid process.
    double sideOf(double y, double z) const noexcept;
    // z of the middle fossa's floor.
    double tegmenAt(double x, double y) const noexcept;
    const TemporalMeasures& measures() const noexcept { return measures_; }

  private:
    // Slow unevenness of the surfaces, -1 .. 1.
    double waves(const Eigen::Vector3d& p) const noexcept;
    double outer(const Eigen::Vector3d& p) const noexcept;
    double cranium(const Eigen::Vector3d& p) const noexcept;
    double sinus(const Eigen::Vector3d& p) const noexcept;
    double canals(const Eigen::Vector3d& p) const noexcept;
    double innerEar(const Eigen::Vector3d& p) const noexcept;
    double ossicles(const Eigen::Vector3d& p) const noexcept;
    double middleEar(const Eigen::Vector3d& p) const noexcept;
    double antrum(const Eigen::Vector3d& p) const noexcept;
    Eigen::Vector3d turned(const Eigen::Vector3d& p) const noexcept;

    TemporalMeasures measures_;
    Eigen::Vector3d bulb_;
    SplineTube sinus_, vein_, nerve_, carotid_, meatus_, ear_canal_;
    std::array<SplineTube, 4> canals_;  // lateral, superior, posterior, common limb
    SplineTube cochlea_;
    std::array<SplineTube, 5> ossicle_limbs_;
    SplineTube aditus_;
};

// What the specimen is cut to: 36 x 40 x 39 mm.
const Eigen::AlignedBox3d& temporalBlock();

}  // namespace bonemill

// Makes the anatomy of a piece of lower jaw with an impacted third molar as signed distances.
//
// Everything is of a left jaw, in mm: x to the cheek, y to the back, z up; the origin is the middle of the
// crest, right behind the second molar. Distances are negative inside, exact to some 20 % near a surface.
// Thread-safe; building allocates, distances do not.
#pragma once

#include "haptic_server/cases/phantom/spline_shapes.h"
#include "haptic_server/cases/phantom/third_molar_phantom.h"
#include "haptic_server/cases/phantom/tooth_phantom.h"

namespace bonemill {

// The tooth of tooth_phantom.h, scaled and put into the jaw by the middle of its crown.
class PlacedTooth {
  public:
    // tilt: rad, of the crown forwards.
    PlacedTooth(double scale, double tilt, const Eigen::Vector3d& crown);

    SoundTooth at(const Eigen::Vector3d& p) const noexcept;  // mm
    // The middle of the part of the roots that lies lowest, and the highest place of the crown.
    Eigen::Vector3d lowest() const noexcept { return lowest_; }
    double highest() const noexcept { return highest_; }
    void move(const Eigen::Vector3d& by) noexcept;

  private:
    double scale_;
    Eigen::Quaterniond turn_;
    Eigen::Vector3d crown_, lowest_;
    double highest_;
};

class MolarShapes {
  public:
    explicit MolarShapes(const ThirdMolarKind& kind);

    double jaw(const Eigen::Vector3d& p) const noexcept;
    double nerve(const Eigen::Vector3d& p) const noexcept { return canal(p) + kCanalRadius - nerve_radius_; }
    double canal(const Eigen::Vector3d& p) const noexcept { return canal_.signedDistance(p); }
    SoundTooth secondMolar(const Eigen::Vector3d& p) const noexcept { return second_.at(p); }
    SoundTooth thirdMolar(const Eigen::Vector3d& p) const noexcept { return third_.at(p); }
    // How thick the cortex is: more towards the cheek than towards the tongue.
    double cortex(const Eigen::Vector3d& p) const noexcept;
    bool isLingual(const Eigen::Vector3d& p) const noexcept;

    static constexpr double kCanalRadius = 1.5;

  private:
    struct Measures {
        explicit Measures(uint64_t seed);
        double tilt, scale, half_width, nerve_aside, nerve_radius, buccal, lingual;
    };
    MolarShapes(const ThirdMolarKind& kind, const Measures& measures);

    Measures measures_;
    PlacedTooth second_, third_;
    double nerve_radius_;
    SplineTube canal_;
};

// What the piece is cut to: 20 x 34 x 36 mm.
const Eigen::AlignedBox3d& jawBlock();

}  // namespace bonemill

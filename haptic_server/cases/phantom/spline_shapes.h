// Makes soft structures of the phantoms: tubes and sheets about smooth curves through given points
// (Catmull-Rom); and puts shapes together that are functions, negative inside.
//
// There is one length unit throughout (the phantoms use mm). Thread-safe; start-up only, allocates.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace bonemill {

// This is a round tube; its ends are round too.
class SplineTube {
  public:
    // There must be at least two points.
    SplineTube(const std::vector<Eigen::Vector3d>& points, double radius);

    // It is the distance to the tube's surface, negative inside; exact but for the curve, which is followed
    // in short straight pieces.
    double signedDistance(const Eigen::Vector3d& p) const noexcept;
    bool contains(const Eigen::Vector3d& p) const noexcept {
        return box_.contains(p) && signedDistance(p) < 0;
    }
    const Eigen::AlignedBox3d& box() const noexcept { return box_; }

  private:
    std::vector<Eigen::Vector3d> curve_;
    double radius_;
    Eigen::AlignedBox3d box_;
};

// This is a membrane over a rectangle of x and y: what lies 0 to `thickness` above a height that runs
// smoothly through a lattice of points.
class SplineSheet {
  public:
    struct Lattice {
        Eigen::Vector2d low, spacing;  // x and y of the first point, and between the points
        std::vector<std::vector<double>>
            heights;  // [row along y][point along x], at least 2 × 2, rows of one size
    };
    SplineSheet(Lattice lattice, double thickness);

    // The place must lie inside the rectangle.
    double heightAt(double x, double y) const noexcept;
    bool contains(const Eigen::Vector3d& p) const noexcept;

  private:
    Lattice lattice_;
    Eigen::Vector2d high_;
    double thickness_;
};

inline double smoothStep(double low, double high, double x) noexcept {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// Makes the smooth union of two implicit shapes with a fillet of about `fillet`.
inline double blend(double a, double b, double fillet) noexcept {
    const double h = std::max(fillet - std::abs(a - b), 0.0) / fillet;
    return std::min(a, b) - h * h * fillet / 4;
}

// This is the first-order distance to an n-dimensional ellipsoid: (|p / r| - 1) over the length
// of its gradient.
template <class V>
double ellipsoidal(const V& p, const V& half_axes) noexcept {
    const V scaled = p.cwiseQuotient(half_axes);
    const double size = scaled.norm();
    if (size < 1e-9) return -half_axes.minCoeff();
    return (size - 1) * size / scaled.cwiseQuotient(half_axes).norm();
}

}  // namespace bonemill

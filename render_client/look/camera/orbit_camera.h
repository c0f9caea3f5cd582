// This camera moves on a sphere around a target: it orbits, zooms, pans and fits.
//
// Frames and angles are those of common/geometry/view_axes.h, lengths in m. It is plain values without a
// thread of its own, and never throws.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "common/geometry/view_axes.h"
#include "render_client/look/camera/camera.h"

namespace bonemill {

class OrbitCamera {
  public:
    static constexpr double kFieldOfView = 0.52;  // rad, vertical: a moderate telephoto keeps proportions
    static constexpr double kMaxElevation = kMaxViewElevation;
    static constexpr double kMinDistance = 5e-4;   // m
    static constexpr double kMaxDistance = 100.0;  // m

    Eigen::Vector3d target_W = Eigen::Vector3d::Zero();  // m
    double distance = 0.3;                               // m, eye to target
    double azimuth = 0.61;                               // rad
    double elevation = 0.44;                             // rad

    // A null or non-finite vector means +z. What is kept has unit length.
    void setUp(const Eigen::Vector3d& up_W) { up_W_ = unitUp(up_W); }
    const Eigen::Vector3d& up_W() const { return up_W_; }

    void orbit(double delta_azimuth, double delta_elevation);
    // A factor below 1 comes nearer.
    void zoom(double factor);
    // The picture follows by these fractions of its height; right and up are positive.
    void pan(double right, double up);

    Eigen::Vector3d eye_W() const { return target_W + distance * towardsEye_W(); }
    Eigen::Vector3d towardsEye_W() const { return R_WC().col(2); }  // of unit length
    // The columns are the camera's axes in W.
    Eigen::Matrix3d R_WC() const { return viewAxes(azimuth, elevation, up_W_); }
    Camera view() const;

    // Centres on the box and goes as near as every corner (m) allows with a margin. The angles stay.
    void fit(std::span<const Eigen::Vector3d> corners_W, double aspect);

  private:
    Eigen::Vector3d up_W_ = Eigen::Vector3d::UnitZ();
};

}  // namespace bonemill

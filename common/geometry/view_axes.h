// Which way a picture looks, for the viewer that draws it and for the hand that thinks in its axes.
//
// The frames are W, the world (LPS of the volume file), and C, the camera: x right, y up, z out of the
// picture. Azimuth 0 looks from the front of the patient (from -y for up = +z); positive azimuth moves the
// eye to the patient's left (+x); positive elevation moves it towards `up`. Angles are in rad. These are pure
// functions, for any thread.
#pragma once

#include <Eigen/Core>

namespace bonemill {

inline constexpr double kMaxViewElevation = 1.553;  // rad, 89°: `up` never meets the line of sight

// Returns it with unit length; a null or non-finite vector means +z.
Eigen::Vector3d unitUp(const Eigen::Vector3d& up_W) noexcept;

// Returns R_WC: its columns are the picture's axes in W, the last towards the eye. `up_W` has unit length;
// the elevation is bounded by kMaxViewElevation.
Eigen::Matrix3d viewAxes(double azimuth, double elevation, const Eigen::Vector3d& up_W) noexcept;

}  // namespace bonemill

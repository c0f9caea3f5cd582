// The axes in which a user of a SpaceMouse or gamepad thinks: those of the picture.
//
// The frames are U, x right, y up and z towards the user in the picture, W and D. It is a pure function.
#pragma once

#include <Eigen/Geometry>

namespace bonemill {

// Returns R_DU for the first view of a scene (message Camera), as OrbitCamera looks. The angles are in rad;
// up_W is taken as by OrbitCamera::setUp().
Eigen::Quaterniond userAxesOf(double azimuth, double elevation, const Eigen::Vector3d& up_W,
                              const Eigen::Quaterniond& R_WD);

}  // namespace bonemill

// From bonemill's frames (m) to what 3D Slicer and OpenIGTLink have: mm, in the patient's axes RAS. The world
// W of a scan is its file's own frame, DICOM's LPS (docs/reference/frames.md): x and y point the other way. A
// scan that does not say how the patient lay (SceneInfo.lacks_patient_axes) is turned all the same, as 3D
// Slicer does with it.
//
// Any thread.
#pragma once

#include <Eigen/Geometry>

#include "common/base/units.h"
#include "common/geometry/pose.h"

namespace bonemill::igtl {

// Half a turn about z.
inline Eigen::Vector3d rasOf(const Eigen::Vector3d& vector_W) {
    return {-vector_W.x(), -vector_W.y(), vector_W.z()};
}

// Takes places in frame B, in mm, to RAS.
inline Eigen::Isometry3d rasOf(const Pose& X_WB) {
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    for (int axis = 0; axis < 3; ++axis)
        place.linear().col(axis) = rasOf(Eigen::Vector3d(X_WB.rotation * Eigen::Vector3d::Unit(axis)));
    place.translation() = rasOf(X_WB.position) * kPerMillimetre;
    return place;
}

}  // namespace bonemill::igtl

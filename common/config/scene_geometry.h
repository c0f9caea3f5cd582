// A scene's vectors and poses as SI vectors and poses; frames are those that the fields name.
#pragma once

#include "common/base/units.h"
#include "common/geometry/pose.h"
#include "proto/scene.pb.h"

namespace bonemill {

inline Eigen::Vector3d vectorOf(const scene::Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

inline Eigen::Vector3d metresOf(const scene::Vec3& v_mm) {
    return kMillimetre * vectorOf(v_mm);
}

inline Eigen::Quaterniond rotationOf(const scene::Quaternion& q) {
    return Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized();
}

// Scene files' waypoints: T in W.
inline Pose poseOf(const scene::SimulatedOperator::Waypoint& waypoint) {
    return {metresOf(waypoint.p_wt_mm()), rotationOf(waypoint.q_wt())};
}

// D in W.
inline Pose poseOf(const scene::Device& device) {
    return {metresOf(device.p_wd_mm()), rotationOf(device.q_wd())};
}

}  // namespace bonemill

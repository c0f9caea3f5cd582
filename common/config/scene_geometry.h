// A scene's vectors, poses and handle in SI; frames are those that the fields name.
#pragma once

#include "common/base/units.h"
#include "common/device_messages/device_messages.h"
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

// What a scene says of the mass, damping and delay of its ARES, as the device itself says it
// (common/device_messages).
inline HandleDynamics handleDynamicsOf(const scene::Scene& scene) {
    const scene::Device& device = scene.device();
    const double step = device.encoder_step_um() * kMicrometre;
    return {.mass = device.moving_mass_kg(),
            .damping = device.viscous_friction_n_s_per_m(),
            .inertia = device.moving_inertia_kg_m2(),
            .angular_damping = device.angular_friction_nm_s_per_rad(),
            .amplifier_time = 1 / (kTurn * device.amplifier_bandwidth_hz()),
            .delay = device.has_delay_ms() ? device.delay_ms() * kMillisecond : 1 / scene.loop().rate_hz(),
            .encoder_step = step,
            // The sliders move on the platform's edge.
            .encoder_angle = step / (device.platform_radius_mm() * kMillimetre)};
}

}  // namespace bonemill

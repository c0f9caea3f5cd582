#include "device_daemon/ares/ares_device/scene_ares.h"

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_geometry.h"

namespace bonemill {
namespace {

AresGeometry geometryOfAres(const scene::Device& device) {
    return {.base_radius = kMillimetre * device.base_radius_mm(),
            .platform_radius = kMillimetre * device.platform_radius_mm(),
            .base_half_angle = kDegree * device.base_half_angle_deg(),
            .platform_half_angle = kDegree * device.platform_half_angle_deg(),
            .link_length = kMillimetre * device.link_length_mm(),
            .stroke = kMillimetre * device.stroke_mm()};
}

MovingWeight weightOf(const scene::Device& device) {
    MovingWeight weight;
    if (device.is_counterweighted()) return weight;
    weight.mass = device.weight_kg();
    weight.centre_T = metresOf(device.weight_centre_t_mm());
    if (!device.has_gravity_d()) return weight;
    weight.down_D = vectorOf(device.gravity_d());
    if (!(weight.down_D.norm() > 0)) {
        throw UserError(
            "field `device.gravity_D`: all of it is 0, which is no direction; where things fall "
            "straight to the base, leave it out or write z: -1");
    }
    weight.down_D.normalize();
    return weight;
}

HomePlace homeOf(const scene::Device& device) {
    return {.X_DT = {metresOf(device.home_p_dt_mm()), Eigen::Quaterniond::Identity()},
            .tolerance = kMillimetre * device.home_tolerance_mm()};
}

void check(const AresDeviceConfig& config) {
    const AresKinematics kinematics(config.geometry);
    if (!kinematics.isBuildable()) {
        throw UserError(
            "field `device`: no platform pose exists for this geometry, or the legs do not hold the "
            "platform: "
            "with link_length_mm the links must reach from base_radius_mm to platform_radius_mm without "
            "leaning "
            "too far, and the half angles must differ");
    }
    if (config.guard.home && kinematics.workspaceFaults(config.guard.home->X_DT) != kWorkspaceOk) {
        throw UserError(
            "field `device.home_p_DT_mm`: the handle cannot stand there: it is out of reach of the "
            "sliders or links");
    }
}

}  // namespace

AresDeviceConfig aresConfigOf(const scene::Device& device, bool is_simulated, const Pose& X_DT_start) {
    AresDeviceConfig config;
    config.geometry = geometryOfAres(device);
    config.guard.encoder_step = kMicrometre * device.encoder_step_um();
    config.guard.friction = device.coulomb_friction_n();
    config.guard.X_DT_start = X_DT_start;
    if (is_simulated) {
        config.guard.stuck_travel = StuckCheck::kSmoothTravel;
        config.guard.has_frozen_check = false;
    } else {
        config.guard.home = homeOf(device);
        config.weight = weightOf(device);
    }
    config.max_actuator_force = device.max_actuator_force_n();
    config.max_force = device.max_force_n();
    config.max_torque = kMilli * device.max_torque_nmm();
    config.is_simulated = is_simulated;
    check(config);
    return config;
}

}  // namespace bonemill

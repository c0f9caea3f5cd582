#include "device_daemon/device_setup/device_setup.h"

#include "common/base/units.h"
#include "common/config/scene_geometry.h"
#include "common/geometry/view_axes.h"
#include "device_daemon/ares/ares_device/ares_settings.h"

namespace bonemill {
namespace {

DeviceLoopConfig loopOf(const scene::Scene& scene) {
    const scene::Safety& safety = scene.safety();
    DeviceLoopConfig loop;
    loop.wrench = {.max_force = scene.coupling().max_force_n(),
                   .max_torque = kMilli * scene.coupling().max_torque_nmm(),
                   .max_force_rate = safety.max_force_rate_n_per_s(),
                   .max_torque_rate = kMilli * safety.max_torque_rate_nmm_per_s()};
    loop.motion.max_speed = kMillimetre * safety.max_speed_mm_per_s();
    loop.motion.max_angular_speed = kDegree * safety.max_angular_speed_deg_per_s();
    loop.motion.max_power = safety.max_power_w();
    loop.motion.max_energy = safety.max_energy_j();
    loop.states.engage_force = safety.engage_force_n();
    loop.states.engage_torque = kMilli * safety.engage_torque_nmm();
    loop.states.engage_time = kMilli * safety.engage_ms();
    loop.states.ramp_time = kMilli * scene.loop().ramp_ms();
    loop.states.silence = kMilli * scene.loop().stale_after_ms();
    return loop;
}

Pose startOf(const scene::SimulatedOperator& person, const Pose& X_WD, const HandSpace& space) {
    if (person.waypoint_size() == 0) return {};
    return space.poseAtHand(X_WD.inverse() * poseOf(person.waypoint(0)));
}

// Pushing away from the user moves the tool away from the scene's first view.
RateConfig ratesOf(const scene::Scene& scene, const Pose& X_WD) {
    const scene::Camera& camera = scene.camera();
    const Eigen::Vector3d up_W =
        unitUp(camera.has_up() ? vectorOf(camera.up()) : Eigen::Vector3d(Eigen::Vector3d::Zero()));
    RateConfig rates;
    rates.hand_space = HandSpace(scene.device().workspace_scale());
    // Its user thinks in the axes of the first picture: U is that camera.
    const Eigen::Matrix3d R_WU =
        viewAxes(kDegree * camera.azimuth_deg(), kDegree * camera.elevation_deg(), up_W);
    rates.R_DU = (X_WD.rotation.conjugate() * Eigen::Quaterniond(R_WU)).normalized();
    return rates;
}

// The delay is a matter of the loop, too.
AresDeviceConfig declaring(const scene::Scene& scene, AresDeviceConfig config) {
    config.handle = handleDynamicsOf(scene);
    return config;
}

}  // namespace

DeviceSetup deviceSetupOf(const scene::Scene& scene) {
    const Pose X_WD = poseOf(scene.device());
    const HandSpace space(scene.device().workspace_scale());
    const Pose X_DT_start = startOf(scene.simulated_operator(), X_WD, space);
    return {.rate_hz = scene.loop().rate_hz(),
            .X_WD = X_WD,
            .hand_space = space,
            .X_DT_start = X_DT_start,
            .ares = declaring(scene, aresConfigOf(scene.device(), false)),
            .simulated_ares = declaring(scene, aresConfigOf(scene.device(), true, X_DT_start)),
            .rates = ratesOf(scene, X_WD),
            .loop = loopOf(scene)};
}

}  // namespace bonemill

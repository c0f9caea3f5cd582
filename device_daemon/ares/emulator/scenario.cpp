#include "device_daemon/ares/emulator/scenario.h"

#include <algorithm>
#include <sstream>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_geometry.h"
#include "common/device_messages/device_messages.h"
#include "common/geometry/hand_space.h"
#include "device_daemon/ares/ares_device/ares_settings.h"

namespace bonemill {
namespace {

constexpr int kChecksPerSegment = 32;

AresPlant plantOf(const scene::Device& device) {
    return {.moving_mass = device.moving_mass_kg(),
            .moving_inertia = device.moving_inertia_kg_m2(),
            .viscous_friction = device.viscous_friction_n_s_per_m(),
            .angular_friction = device.angular_friction_nm_s_per_rad(),
            .coulomb_friction = device.coulomb_friction_n(),
            .amplifier_bandwidth_hz = device.amplifier_bandwidth_hz(),
            .encoder_step = kMicrometre * device.encoder_step_um(),
            .unbalanced_mass = device.unbalanced_mass_kg(),
            .play = kMicrometre * device.play_um()};
}

HandImpedance handOf(const scene::SimulatedOperator& person) {
    return {.mass = person.hand_mass_kg(),
            .damping = person.hand_damping_n_s_per_m(),
            .stiffness = person.hand_stiffness_n_per_m(),
            .inertia = person.hand_inertia_kg_m2(),
            .angular_damping = person.hand_angular_damping_nm_s_per_rad(),
            .angular_stiffness = person.hand_angular_stiffness_nm_per_rad()};
}

// The handle moves less than the tool by the workspace's scale.
OperatorPath pathOf(const scene::SimulatedOperator& person, const Pose& X_WD, const HandSpace& space) {
    const Pose X_DW = X_WD.inverse();
    std::vector<Waypoint> waypoints;
    for (const auto& waypoint : person.waypoint()) {
        const uint32_t buttons =
            (waypoint.remove() ? kButtonRemove : 0u) | (waypoint.add() ? kButtonAdd : 0u);
        waypoints.push_back({waypoint.time_s(), space.poseAtHand(X_DW * poseOf(waypoint)), buttons});
    }
    return OperatorPath(std::move(waypoints), space.wayAtHand(kMillimetre * person.tremor_mm()));
}

std::vector<std::string> phasesOf(const scene::SimulatedOperator& person) {
    std::vector<std::string> phases;
    for (const auto& waypoint : person.waypoint()) {
        const bool goes_on = waypoint.phase().empty() && !phases.empty();
        phases.push_back(goes_on ? phases.back() : waypoint.phase());
    }
    return phases;
}

std::string reasonOf(uint32_t workspace_faults) {
    if (workspace_faults & kWorkspaceUnreachable) return "a link is too short";
    if (workspace_faults & kWorkspaceStroke) return "a slider leaves its stroke";
    if (workspace_faults & kWorkspaceTurn) return "the handle turns too far";
    return "a link leans too far";
}

void checkPath(const scene::SimulatedOperator& person, const Scenario& scenario) {
    const AresKinematics kinematics(scenario.geometry);
    for (int i = 0; i < person.waypoint_size(); ++i) {
        const double from = person.waypoint(std::max(i - 1, 0)).time_s();
        const double to = person.waypoint(i).time_s();
        for (int k = 1; k <= kChecksPerSegment; ++k) {
            const double t = from + (to - from) * k / kChecksPerSegment;
            const Pose X_DT = scenario.path.at(t).X_DT;
            const uint32_t faults = kinematics.workspaceFaults(X_DT);
            if (faults == kWorkspaceOk) continue;
            const Eigen::Vector3d p_mm = X_DT.position / kMillimetre;
            const double turn_deg = logRotation(X_DT.rotation).norm() / kDegree;
            std::ostringstream message;
            message.precision(4);
            message << "field `simulated_operator.waypoint[" << i
                    << "]` or the way to it leaves the device's workspace: " << reasonOf(faults)
                    << " at t = " << t << " s, where the handle is at (" << p_mm.x() << ", " << p_mm.y()
                    << ", " << p_mm.z() << ") mm and turned by " << turn_deg
                    << " deg from the device's neutral pose (about 25 mm per axis and 40 deg are possible): "
                       "move the "
                       "waypoint, or the device with device.p_WD_mm and device.q_WD";
            throw UserError(message.str());
        }
    }
}

}  // namespace

Scenario scenarioOf(const scene::Scene& scene) {
    const scene::Device& device = scene.device();
    const Pose X_WD = poseOf(device);
    Scenario scenario{.rate_hz = scene.loop().rate_hz(),
                      .geometry = aresConfigOf(device, true).geometry,
                      .plant = plantOf(device),
                      .hand = handOf(scene.simulated_operator()),
                      .path = pathOf(scene.simulated_operator(), X_WD, HandSpace(device.workspace_scale())),
                      .phases = phasesOf(scene.simulated_operator()),
                      .max_actuator_force = device.max_actuator_force_n(),
                      .max_force = device.max_force_n(),
                      .max_torque = kMilli * device.max_torque_nmm()};
    checkPath(scene.simulated_operator(), scenario);
    return scenario;
}

std::string phaseOf(const Scenario& scenario, int waypoint) {
    if (waypoint < 0 || scenario.phases[size_t(waypoint)].empty()) return "hold";
    return scenario.phases[size_t(waypoint)];
}

}  // namespace bonemill

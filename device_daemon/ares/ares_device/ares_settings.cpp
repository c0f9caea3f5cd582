#include "device_daemon/ares/ares_device/ares_settings.h"

#include <iomanip>
#include <sstream>

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/ares_kinematics/scene_ares.h"
#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_geometry.h"

namespace bonemill {
namespace {

void addGeometry(std::ostringstream& out, const AresGeometry& geometry) {
    out << "geometry (a placeholder: no dimension of ARES is published)\n"
        << "  base radius " << geometry.base_radius * kPerMillimetre << " mm, platform radius "
        << geometry.platform_radius * kPerMillimetre << " mm\n"
        << "  half angle of a leg pair: base " << geometry.base_half_angle / kDegree << " deg, platform "
        << geometry.platform_half_angle / kDegree << " deg\n"
        << "  six links of " << geometry.link_length * kPerMillimetre << " mm, six strokes of "
        << geometry.stroke * kPerMillimetre << " mm\n";
}

void addFrames(std::ostringstream& out) {
    out << "frames\n"
        << "  D (device): origin at the platform's centre in the neutral pose, +z from the base to the "
           "platform\n"
        << "  T (handle): fixed to the platform, origin at its centre; in the neutral pose T is D\n";
}

void addWorkspace(std::ostringstream& out, const AresKinematics& kinematics) {
    Matrix6d J_inv;
    kinematics.inverseJacobian({}, J_inv);
    out << "workspace\n"
        << "  ball around D's origin: " << reachRadius(kinematics, 0) * kPerMillimetre << " mm level, "
        << reachRadius(kinematics, kSpecifiedTurn) * kPerMillimetre << " mm turned by "
        << kSpecifiedTurn / kDegree << " deg about any axis\n"
        << "  largest turn " << kMaxTurn / kDegree << " deg, smallest cosine of a link's lean "
        << kMinLinkCosine << "\n"
        << "  singularity index " << singularityIndex(J_inv) << " in the neutral pose, refused below "
        << kMinSingularityIndex << "\n";
}

void addLimits(std::ostringstream& out, const AresDeviceConfig& config) {
    out << "limits\n"
        << "  on the hand " << config.max_force << " N and " << config.max_torque << " N m, per actuator "
        << config.max_actuator_force << " N\n"
        << "  a slider faster than " << config.guard.largest_slider_speed
        << " m/s is an encoder that jumps\n";
}

void addWeight(std::ostringstream& out, const MovingWeight& weight) {
    out << "weight\n  ";
    if (weight.mass > 0) {
        out << weight.mass << " kg held by the motors, falling along (" << weight.down_D.transpose()
            << ") of D\n";
    } else {
        out << "balanced by a counterweight: the motors hold none\n";
    }
}

void addHome(std::ostringstream& out, const std::optional<HomePlace>& home) {
    out << "home place\n  ";
    if (home) {
        out << "(" << (home->X_DT.position * kPerMillimetre).transpose()
            << ") mm in D, level; every slider within " << home->tolerance * kPerMillimetre << " mm\n";
    } else {
        out << "not checked: an encoder that is off from the start is not found\n";
    }
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

std::string describe(const AresDeviceConfig& config) {
    std::ostringstream out;
    out << std::setprecision(3) << (config.is_simulated ? "ARES emulator" : "ARES")
        << ", 6 axes in and out\n";
    addGeometry(out, config.geometry);
    addFrames(out);
    addWorkspace(out, AresKinematics(config.geometry));
    addLimits(out, config);
    addWeight(out, config.weight);
    addHome(out, config.guard.home);
    return out.str();
}

AresDeviceConfig aresConfigOf(const scene::Device& device, bool is_simulated, const Pose& X_DT_start) {
    AresDeviceConfig config;
    config.geometry = aresGeometryOf(device);
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

#include "device_daemon/ares/ares_device/describe_ares.h"

#include <iomanip>
#include <sstream>

#include "common/base/units.h"
#include "device_daemon/ares/ares_device/workspace_figures.h"
#include "device_daemon/ares/kinematics/singularity.h"

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

}  // namespace bonemill

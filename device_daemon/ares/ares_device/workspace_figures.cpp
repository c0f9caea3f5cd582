#include "device_daemon/ares/ares_device/workspace_figures.h"

#include <cmath>
#include <numbers>

#include "device_daemon/ares/kinematics/singularity.h"

namespace bonemill {
namespace {

constexpr int kDirections = 64, kAxes = 48;
constexpr int kHalvings = 9;  // to 1 / 512 of what is searched

// Spreads directions evenly over the sphere, along a spiral with the golden angle.
Eigen::Vector3d direction(int i, int count) {
    const double z = 1 - (2.0 * i + 1) / count;
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double radius = std::sqrt(1 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

bool isUsable(const AresKinematics& kinematics, const Pose& X_DT) {
    Matrix6d J_inv;
    return kinematics.workspaceFaults(X_DT) == kWorkspaceOk && kinematics.inverseJacobian(X_DT, J_inv) &&
           kinematics.isOwnAssembly(J_inv) && singularityIndex(J_inv) >= kMinSingularityIndex;
}

bool isUsableTurned(const AresKinematics& kinematics, const Eigen::Vector3d& p_DT, double turn) {
    if (!isUsable(kinematics, {p_DT, Eigen::Quaterniond::Identity()})) return false;
    for (int i = 0; turn > 0 && i < kAxes; ++i) {
        if (!isUsable(kinematics, {p_DT, expRotation(turn * direction(i, kAxes))})) return false;
    }
    return true;
}

}  // namespace

double reachRadius(const AresKinematics& kinematics, double turn) noexcept {
    double radius = kinematics.geometry().stroke / 2;
    for (int i = 0; i < kDirections; ++i) {
        const Eigen::Vector3d way = direction(i, kDirections);
        if (isUsableTurned(kinematics, radius * way, turn)) continue;
        double inside = 0, outside = radius;
        for (int k = 0; k < kHalvings; ++k) {
            const double middle = (inside + outside) / 2;
            (isUsableTurned(kinematics, middle * way, turn) ? inside : outside) = middle;
        }
        radius = inside;
    }
    return radius;
}

}  // namespace bonemill

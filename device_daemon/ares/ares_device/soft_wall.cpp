#include "device_daemon/ares/ares_device/soft_wall.h"

#include <algorithm>
#include <cmath>

#include "common/ares_kinematics/ares_kinematics.h"

namespace bonemill {
namespace {

double smoothstep(double depth) {
    const double u = std::clamp(depth, 0.0, 1.0);
    return u * u * (3 - 2 * u);
}

// Its derivative over the depth is smoothstep().
double smoothstepIntegral(double depth) {
    const double u = std::clamp(depth, 0.0, 1.0);
    return u * u * u * (1 - u / 2) + std::max(0.0, depth - 1);
}

// Runs from -1 to 1, with slope 1 at 0.
double saturated(double x) {
    return x / std::sqrt(1 + x * x);
}

}  // namespace

struct SoftWall::Sum {
    const SoftWallConfig& config;
    const Vector6d& twist;
    Vector6d wrench = Vector6d::Zero();
    double energy = 0;
    bool touches = false;

    // Adds a wall at this depth, with the depth's gradient over the twist. `stiffness` is the spring's
    // energy per smoothstepIntegral().
    void add(double depth, const Vector6d& gradient, double stiffness) {
        if (!(depth > 0)) return;
        const double damping = config.damping_share * saturated(config.damping_time * gradient.dot(twist));
        wrench -= stiffness * smoothstep(depth) * (1 + damping) * gradient;
        energy += stiffness * smoothstepIntegral(depth);
        touches = true;
    }
};

WallReaction SoftWall::at(const Pose& X_DT, const Matrix6d& J_inv, const Vector6d& twist_D) const noexcept {
    Sum sum{config_, twist_D};
    addStrokes(X_DT, J_inv, sum);
    addLeans(X_DT, sum);
    addTurn(X_DT, sum);
    addSingularity(X_DT, J_inv, sum);
    return {{sum.wrench.head<3>(), sum.wrench.tail<3>()}, sum.energy, sum.touches};
}

void SoftWall::addStrokes(const Pose& X_DT, const Matrix6d& J_inv, Sum& sum) const noexcept {
    Vector6d q;
    if (!kinematics_.inverse(X_DT, q)) return;
    const double width = config_.stroke_width;
    const double stiffness = config_.force * width;
    for (int i = 0; i < kLegCount; ++i) {
        const Vector6d gradient = J_inv.row(i).transpose() / width;
        sum.add(1 - q[i] / width, -gradient, stiffness);
        sum.add(1 - (kinematics_.geometry().stroke - q[i]) / width, gradient, stiffness);
    }
}

void SoftWall::addLeans(const Pose& X_DT, Sum& sum) const noexcept {
    Vector6d heights;
    Matrix6d gradient;
    if (!kinematics_.linkHeights(X_DT, heights, gradient)) return;
    const double lowest = kMinLinkCosine * kinematics_.geometry().link_length;
    const double width = config_.lean_width;
    for (int i = 0; i < kLegCount; ++i) {
        sum.add(1 - (heights[i] - lowest) / width, -gradient.row(i).transpose() / width,
                config_.force * width);
    }
}

void SoftWall::addTurn(const Pose& X_DT, Sum& sum) const noexcept {
    const Eigen::Vector3d turn = logRotation(X_DT.rotation);
    const double angle = turn.norm();
    if (!(angle > kMaxTurn - config_.turn_width)) return;
    Vector6d gradient = Vector6d::Zero();  // the angle grows by the spin about its own axis
    gradient.tail<3>() = turn / (angle * config_.turn_width);
    sum.add(1 - (kMaxTurn - angle) / config_.turn_width, gradient, config_.torque * config_.turn_width);
}

void SoftWall::addSingularity(const Pose& X_DT, const Matrix6d& J_inv, Sum& sum) const noexcept {
    const double width = config_.singular_face - config_.singular_end;
    const double depth = (config_.singular_face - smoothIndex(J_inv)) / width;
    std::array<Matrix6d, 6> J_inv_changes;
    if (!(depth > 0) || !kinematics_.inverseJacobianGradient(X_DT, J_inv_changes)) return;
    Vector6d gradient;
    for (int k = 0; k < 6; ++k) gradient[k] = -smoothIndexChange(J_inv, J_inv_changes[k]) / width;
    // smoothstepIntegral(1) is one half.
    sum.add(depth, gradient, 2 * config_.energy);
}

}  // namespace bonemill

#include "device_daemon/hands/input/rate_control.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/bounded_vector.h"
#include "device_daemon/hands/virtual_handle/virtual_handle.h"

namespace bonemill {
namespace {

constexpr double kLinearShare = 0.25;  // of the curve; the rest is cubic
constexpr double kFreeStretch = 0.5;   // of the leash: a free handle trails by less and is not slowed

// The deflections of one triple, bounded together so that a diagonal is no faster than an axis.
Eigen::Vector3d sharesOf(const float* deflections, double dead_zone) noexcept {
    const Eigen::Vector3d shares(responseOf(deflections[0], dead_zone), responseOf(deflections[1], dead_zone),
                                 responseOf(deflections[2], dead_zone));
    return bounded(shares, 1);
}

// Takes away the part of `rate` that would stretch farther, the more of it the nearer the leash's end is.
Eigen::Vector3d slowedBy(const Eigen::Vector3d& stretch, double longest,
                         const Eigen::Vector3d& rate) noexcept {
    const double length = stretch.norm();
    if (length <= kFreeStretch * longest) return rate;
    const Eigen::Vector3d outward = stretch / length;
    const double outward_rate = std::max(0.0, rate.dot(outward));
    const double left = std::clamp((longest - length) / ((1 - kFreeStretch) * longest), 0.0, 1.0);
    return rate - (1 - left) * outward_rate * outward;
}

}  // namespace

double responseOf(double deflection, double dead_zone) noexcept {
    const double size = std::abs(deflection);
    if (!(size > dead_zone)) return 0;
    const double share = std::min((size - dead_zone) / (1 - dead_zone), 1.0);
    return std::copysign(share * (kLinearShare + (1 - kLinearShare) * share * share), deflection);
}

Rates ratesOf(const std::array<float, 6>& deflections, bool is_fine, const RateConfig& config) noexcept {
    const double mode = is_fine ? config.fine_share : 1;
    const double speed = config.hand_space.wayAtHand(mode * config.max_speed);
    return {config.R_DU * (speed * sharesOf(deflections.data(), config.dead_zone)),
            config.R_DU * (mode * config.max_spin * sharesOf(deflections.data() + 3, config.dead_zone))};
}

void RateWish::advance(double elapsed, const Rates& rates, const Pose& X_DT_handle) noexcept {
    const double dt = std::clamp(elapsed, 0.0, VirtualHandle::kLongestElapsed);
    Eigen::Vector3d lead = X_DT_.position - X_DT_handle.position;
    lead += dt * slowedBy(lead, leash_.distance, rates.v_D);
    Eigen::Vector3d turn = logRotation(X_DT_.rotation * X_DT_handle.rotation.conjugate());
    turn = logRotation(expRotation(dt * slowedBy(turn, leash_.angle, rates.w_D)) * expRotation(turn));
    X_DT_ = X_DT_handle.incremented(bounded(lead, leash_.distance), bounded(turn, leash_.angle));
}

}  // namespace bonemill

#include "device_daemon/hands/input/rate_device.h"

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

Leash leashOf(const VirtualHand& hand) {
    return {.distance = hand.max_force / hand.stiffness, .angle = hand.max_torque / hand.angular_stiffness};
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

RateDevice::RateDevice(DeviceKind kind, std::string_view name, const RateConfig& config,
                       const Pose& X_DT_start)
    : kind_(kind), config_(config), handle_(X_DT_start), wish_(X_DT_start, leashOf(VirtualHand{})) {
    takeName(name);
}

DeviceCapabilities RateDevice::capabilities() const noexcept {
    Name name{};
    name_.tryRead(name);
    return handleCapabilities(kind_, name.text);
}

bool RateDevice::read(double elapsed, DeviceReading& reading) noexcept {
    newest_.tryRead(input_);
    follow(elapsed);
    handle_.advance(elapsed, wrench_hand_D_);
    buttons_.store(input_.buttons, std::memory_order_relaxed);
    reading = readingOf(handle_, wrench_hand_D_, input_.buttons);
    return input_.is_there;
}

void RateDevice::follow(double elapsed) noexcept {
    if (input_.is_there) {
        wish_.advance(elapsed, ratesOf(input_.deflections, input_.is_fine, config_), handle_.pose());
    } else if (was_there_) {
        wish_.restAt(handle_.pose());
    }
    was_there_ = input_.is_there;
    handle_.want(wish_.pose());
}

void RateDevice::write(const DeviceOrder& order) noexcept {
    wrench_hand_D_ = feltWrench(order);
    force_.store(static_cast<float>(wrench_hand_D_.force.norm()), std::memory_order_relaxed);
}

void RateDevice::takeName(std::string_view name) noexcept {
    Name bounded_name{};
    name.copy(bounded_name.text, sizeof bounded_name.text - 1);
    name_.write(bounded_name);
    names_.fetch_add(1, std::memory_order_release);
}

RateDevice::Felt RateDevice::felt() const noexcept {
    return {.force = force_.load(std::memory_order_relaxed),
            .buttons = buttons_.load(std::memory_order_relaxed)};
}

}  // namespace bonemill

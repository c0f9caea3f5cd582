#include "device_daemon/hands/input/rate_device.h"

namespace bonemill {
namespace {

Leash leashOf(const VirtualHand& hand) {
    return {.distance = hand.max_force / hand.stiffness, .angle = hand.max_torque / hand.angular_stiffness};
}

}  // namespace

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

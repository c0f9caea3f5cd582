#include "haptic_server/core/tick/device_fit.h"

#include <limits>

namespace bonemill {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double mostQuick(double max_stiffness) noexcept {
    return max_stiffness > 0 ? max_stiffness : kNoLimit;
}

}  // namespace

DeviceFit::DeviceFit(const TickConfig& config, const EnergyCouplingConfig& coupling,
                     const DeviceCapabilities& device) noexcept
    : coupling_(coupling), space_(config.hand_space) {
    const HandleDynamics& handle = device.handle;
    const LoopSprings push{space_.forcePerWayAtHand(coupling.translation_stiffness), coupling.relaxing_share,
                           coupling.relaxing_time, coupling.damping_time};
    translation_ = {{handle.mass, handle.damping, handle.amplifier_time, handle.delay},
                    push,
                    mostQuick(device.max_stiffness),
                    config.dt};
    if (!(device.abilities & kAbilityTorque)) return;
    const LoopSprings turn{space_.torqueAtHand(coupling.rotation_stiffness), 0, coupling.relaxing_time,
                           coupling.damping_time};
    rotation_ = {{handle.inertia, handle.angular_damping, handle.amplifier_time, handle.delay},
                 turn,
                 mostQuick(device.max_rotation_stiffness),
                 config.dt};
}

// The torque saturates at the angle at which it did before.
EnergyCouplingConfig DeviceFit::coupling() const noexcept {
    EnergyCouplingConfig fitted = coupling_;
    if (const LoopSprings& push = translation_.springs(); push.stiffness > 0) {
        fitted.translation_stiffness = space_.forcePerWayAtTool(push.stiffness);
        fitted.relaxing_share = push.relaxing_share;
        fitted.relaxing_time = push.relaxing_time;
    }
    if (const LoopSprings& turn = rotation_.springs(); turn.stiffness > 0) {
        fitted.rotation_stiffness = space_.torqueAtTool(turn.stiffness);
        fitted.saturation_torque *= fitted.rotation_stiffness / coupling_.rotation_stiffness;
    }
    return fitted;
}

HandSide fittedHandSide(const TickConfig& config, const DeviceCapabilities& device) noexcept {
    HandSide side = handSideOf(config, device);
    DeviceFit fit(config, side.gradient, device);
    fit.finish();
    side.setGradient(fit.coupling(), config.hand_space);
    return side;
}

}  // namespace bonemill

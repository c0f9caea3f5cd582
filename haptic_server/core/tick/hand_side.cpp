#include "haptic_server/core/tick/hand_side.h"

#include <algorithm>

#include "common/base/units.h"

namespace bonemill {
namespace {

// These are the least that a scene may ask for of coupling.max_force_n, max_torque_nmm and the stiffnesses. A
// device that says less, and not 0, gives nothing that could be felt or would hold the tool.
constexpr double kMinForce = 0.1;                             // N
constexpr double kMinTorque = 0.1 * kMillimetre;              // N·m
constexpr double kMinStiffness = 1e-3 / kMillimetre;          // N/m
constexpr double kMinRotationStiffness = 0.05 * kMillimetre;  // N·m/rad

double forceOf(const DeviceCapabilities& device) noexcept {
    return device.abilities & kAbilityForce && device.max_force >= kMinForce ? device.max_force : 0;
}
double torqueOf(const DeviceCapabilities& device) noexcept {
    return device.abilities & kAbilityTorque && device.max_torque >= kMinTorque ? device.max_torque : 0;
}

// It is as stiff as the quicker of the two laws.
HandSpring springOf(const HandSide& side, const HandSpace& space) noexcept {
    const EnergyCouplingConfig& gradient = side.gradient;
    return {.stiffness = std::max(side.thesis.translation_stiffness,
                                  gradient.translation_stiffness * (1 + gradient.relaxing_share)),
            .rotation_stiffness =
                space.torqueAtHand(std::max(side.thesis.rotation_stiffness / 2, gradient.rotation_stiffness)),
            .lever = space.wayAtHand(gradient.p_TG.norm())};
}

void limitStiffness(HandSide& side, double most) noexcept {
    side.thesis.translation_stiffness = std::min(side.thesis.translation_stiffness, most);
    double& stiffness = side.gradient.translation_stiffness;
    stiffness = std::min(stiffness, most / (1 + side.gradient.relaxing_share));
}

// The torque saturates at the angle at which it did before.
void limitRotationStiffness(HandSide& side, double most) noexcept {
    side.thesis.rotation_stiffness = std::min(side.thesis.rotation_stiffness, 2 * most);
    double& stiffness = side.gradient.rotation_stiffness;
    if (stiffness <= most) return;
    side.gradient.saturation_torque *= most / stiffness;
    stiffness = most;
}

void fitForce(HandSide& side, const DeviceCapabilities& device, const HandSpace& space) noexcept {
    side.limits.max_force = std::min(side.limits.max_force, forceOf(device));
    if (side.limits.max_force == 0) return;
    side.most_pull = side.limits.max_force;
    if (device.max_stiffness > 0)
        limitStiffness(side, space.forcePerWayAtTool(std::max(device.max_stiffness, kMinStiffness)));
}

void fitTorque(HandSide& side, const DeviceCapabilities& device, const HandSpace& space) noexcept {
    side.limits.max_torque = std::min(side.limits.max_torque, torqueOf(device));
    if (side.limits.max_torque == 0) return;
    if (device.max_rotation_stiffness > 0)
        limitRotationStiffness(
            side, space.torqueAtTool(std::max(device.max_rotation_stiffness, kMinRotationStiffness)));
    side.gradient.saturation_torque =
        std::min(side.gradient.saturation_torque, space.torqueAtTool(side.limits.max_torque));
}

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double mostQuick(double max_stiffness) noexcept {
    return max_stiffness > 0 ? max_stiffness : kNoLimit;
}

}  // namespace

void HandSide::setGradient(const EnergyCouplingConfig& coupling, const HandSpace& space) noexcept {
    gradient = coupling;
    spring = springOf(*this, space);
}

void setHandSpace(TickConfig& config, const HandSpace& space) noexcept {
    config.hand_space = space;
    const auto bring = [&space](double& push, double& turn) {
        push = space.forcePerWayAtTool(push);
        turn = space.torqueAtTool(turn);
    };
    bring(config.coupling.translation_stiffness, config.coupling.rotation_stiffness);
    EnergyCouplingConfig& gradient = config.gradient.coupling;
    bring(gradient.translation_stiffness, gradient.rotation_stiffness);
    gradient.saturation_torque = space.torqueAtTool(gradient.saturation_torque);
}

HandSide handSideOf(const TickConfig& config) noexcept {
    HandSide side{
        .limits = config.hand, .spring = {}, .thesis = config.coupling, .gradient = config.gradient.coupling};
    side.spring = springOf(side, config.hand_space);
    return side;
}

HandSide handSideOf(const TickConfig& config, const DeviceCapabilities& device) noexcept {
    HandSide side = handSideOf(config);
    fitForce(side, device, config.hand_space);
    fitTorque(side, device, config.hand_space);
    side.spring = springOf(side, config.hand_space);
    return side;
}

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

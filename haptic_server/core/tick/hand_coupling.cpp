#include "haptic_server/core/tick/hand_coupling.h"

#include <algorithm>

#include "common/geometry/bounded_vector.h"
#include "common/math/pinned_math.h"

namespace bonemill {
namespace {

constexpr int kMaxGiven = 5;
constexpr double kHalf = 0.5;
constexpr double kComesBackAfter = 1;  // s in the air
// A fit that is nearly as stiff as the wish is in force at once.
constexpr double kNearlyAll = 0.9;

double halved(double value, int times) noexcept {
    return value * pinned::pow(kHalf, times);
}

}  // namespace

void HandCoupling::adaptTo(const DeviceCapabilities& device) noexcept {
    side_ = handSideOf(config_, device);
    wished_ = fitted_ = side_.gradient;
    fit_ = DeviceFit(config_, wished_, device);
    is_fitted_ = fit_.isDone();
    tank_.setDevice(device.handle, side_.spring, config_.hand_space,
                    {.force = side_.limits.max_force > 0, .torque = side_.limits.max_torque > 0});
    given_ = given_turns_ = 0;
    stands_alone_ = true;
    has_device_ = true;
}

bool HandCoupling::goOnFitting() noexcept {
    if (is_fitted_) return false;
    fit_.advance();
    if (!fit_.isDone()) return false;
    is_fitted_ = true;
    fitted_ = fit_.coupling();
    use();
    return true;
}

bool HandCoupling::takeAccount(const Pose& X_VT_device, const SpoStep& step) noexcept {
    if (!has_device_) return false;
    const bool is_another = goOnFitting();
    in_air_for_ = step.contacts == 0 ? in_air_for_ + config_.dt : 0;
    if (is_another || !step.is_solved) {
        tank_.fill();
        return is_another;
    }
    PortStep port{X_VT_device, step.wrench_hand_V, step.stored_energy, step.effects_work};
    const HandLimitsConfig& limits = side_.limits;
    if (limits.max_force > 0) limitLength(port.wrench_hand_V.force, limits.max_force);
    if (limits.max_torque > 0)
        limitLength(port.wrench_hand_V.torque, config_.hand_space.torqueAtTool(limits.max_torque));
    tank_.add(port);
    if (tank_.isEmpty()) {
        give(tank_.turnsMoreThanMoves());
        tank_.fill();
        return true;
    }
    if (in_air_for_ < kComesBackAfter || given_ + given_turns_ == 0) return false;
    given_ = given_turns_ = 0;
    use();
    tank_.fill();
    return true;
}

void HandCoupling::give(bool turns) noexcept {
    int& given = turns ? given_turns_ : given_;
    given = std::min(given + 1, kMaxGiven);
    use();
}

void HandCoupling::use() noexcept {
    const bool has_two_levels = fitted_.translation_stiffness < kNearlyAll * wished_.translation_stiffness;
    stands_alone_ = !has_two_levels || given_ > 0;
    // The fit's relaxing spring belongs to the fit's stiffness.
    EnergyCouplingConfig coupling = stands_alone_ ? fitted_ : wished_;
    coupling.translation_stiffness =
        halved(coupling.translation_stiffness, has_two_levels ? std::max(0, given_ - 1) : given_);
    coupling.rotation_stiffness = halved(fitted_.rotation_stiffness, given_turns_);
    coupling.saturation_torque = halved(fitted_.saturation_torque, given_turns_);
    side_.setGradient(coupling, config_.hand_space);
}

}  // namespace bonemill

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
// A swing of this size is to become so much smaller by softer springs. The relaxing spring then damps it in
// any device that is late by less than kCalmShare times kCalmTime.
constexpr double kSmaller = 0.75, kLeastKept = 0.3, kMostKept = 0.7, kSoftest = 1.0 / 64;
constexpr double kCalmShare = 3, kCalmTime = 4e-3;
// Stiffness that was taken comes back in steps, and later and later where it does not last.
constexpr double kFirstRest = 10, kLongestRest = 600, kRestBetween = 1;  // s
constexpr double kStiffensBy = 1.25;
constexpr double kSlackGoes = 0.2;  // s, in the air

double calmer(double kept, double to_least) noexcept {
    return std::max(kSoftest, kept * std::clamp(kSmaller * to_least, kLeastKept, kMostKept));
}

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
    calmed_ = calmed_turns_ = 1;
    rested_for_ = 0;
    comes_back_after_ = kFirstRest;
    is_stiffening_ = false;
    slack_.setZero();
    watch_.expectOtherDevice(device.handle.mass > 0);
    stands_alone_ = true;
    has_device_ = true;
    device_ = device;
}

void HandCoupling::beginAnew() noexcept {
    stretched_ = 1;
    if (has_device_) return adaptTo(DeviceCapabilities(device_));
    side_ = handSideOf(config_);
    wished_ = side_.gradient;
    tank_.fill();
    watch_.begin();
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

bool HandCoupling::takeAccount(const Pose& X_VT_device, const SpoStep& step, bool is_milling) noexcept {
    if (!has_device_) return false;
    stretched_ = 1;
    const bool is_another = goOnFitting();
    if (step.contacts == 0) slack_ *= std::max(0.0, 1 - config_.dt / kSlackGoes);
    in_air_for_ = step.contacts == 0 ? in_air_for_ + config_.dt : 0;
    if (is_another || !step.is_solved) {
        tank_.fill();
        watch_.begin();
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
        soften(X_VT_device, step.X_VT);
        tank_.fill();
        watch_.settle();
        return true;
    }
    if (calm(port, step.contacts > 0, is_milling)) {
        soften(X_VT_device, step.X_VT);
        tank_.fill();
        return true;
    }
    if (in_air_for_ < kComesBackAfter || given_ + given_turns_ == 0) return false;
    given_ = given_turns_ = 0;
    use();
    tank_.fill();
    return true;
}

// Softens what does not come to rest, and stiffens again what has been at rest for long. True: the coupling
// is another from now on.
bool HandCoupling::calm(const PortStep& port, bool is_touching, bool is_milling) noexcept {
    if (is_milling) {
        watch_.begin();
        return false;
    }
    const Unrest unrest = watch_.add(port.X_VT_device, port.wrench_hand_V, is_touching);
    rested_for_ = unrest.isAny() ? 0 : rested_for_ + config_.dt;
    if (rested_for_ > comes_back_after_) return stiffen();
    if (!unrest.isAny()) return false;
    if (is_stiffening_) comes_back_after_ = std::min(2 * comes_back_after_, kLongestRest);
    is_stiffening_ = false;
    if (unrest.force_rms > 0) calmed_ = calmer(calmed_, UnrestWatch::kLeastForce / unrest.force_rms);
    if (unrest.torque_rms > 0)
        calmed_turns_ = calmer(calmed_turns_, UnrestWatch::kLeastTorque / unrest.torque_rms);
    watch_.settle();
    return true;
}

bool HandCoupling::stiffen() noexcept {
    rested_for_ = comes_back_after_ - kRestBetween;
    if (calmed_ == 1 && calmed_turns_ == 1) return false;
    is_stiffening_ = true;
    calmed_ = std::min(1.0, calmed_ * kStiffensBy);
    calmed_turns_ = std::min(1.0, calmed_turns_ * kStiffensBy);
    watch_.begin();
    return true;
}

// The pull stays what it is, so that the hand does not fall to another place.
void HandCoupling::soften(const Pose& X_VT_device, const Pose& X_VT) noexcept {
    const double before = side_.gradient.translation_stiffness;
    use();
    stretched_ = before / side_.gradient.translation_stiffness;
    const Eigen::Vector3d stretch =
        pulledFrom(X_VT_device) * side_.gradient.p_TG - X_VT * side_.gradient.p_TG;
    slack_ += (stretched_ - 1) * stretch;
}

void HandCoupling::give(bool turns) noexcept {
    int& given = turns ? given_turns_ : given_;
    given = std::min(given + 1, kMaxGiven);
}

void HandCoupling::use() noexcept {
    const bool has_two_levels = fitted_.translation_stiffness < kNearlyAll * wished_.translation_stiffness;
    stands_alone_ = !has_two_levels || given_ > 0;
    // The fit's relaxing spring belongs to the fit's stiffness.
    EnergyCouplingConfig coupling = stands_alone_ ? fitted_ : wished_;
    coupling.translation_stiffness =
        halved(coupling.translation_stiffness, has_two_levels ? std::max(0, given_ - 1) : given_);
    if (calmed_ < 1) {
        coupling.translation_stiffness *= calmed_;
        const double most_quick = (1 + coupling.relaxing_share) / calmed_;
        coupling.relaxing_share = std::max(coupling.relaxing_share, std::min(kCalmShare, most_quick - 1));
        coupling.relaxing_time = std::max(coupling.relaxing_time, kCalmTime);
    }
    coupling.rotation_stiffness = calmed_turns_ * halved(fitted_.rotation_stiffness, given_turns_);
    coupling.saturation_torque = calmed_turns_ * halved(fitted_.saturation_torque, given_turns_);
    side_.setGradient(coupling, config_.hand_space);
}

}  // namespace bonemill

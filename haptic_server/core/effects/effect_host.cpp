#include "haptic_server/core/effects/effect_host.h"

#include <cmath>

#include "haptic_server/core/effects/burr_speed.h"

namespace bonemill {

EffectHost::EffectHost(EffectList effects, size_t most_candidates, double stiffness_per_area)
    : effects_(std::move(effects)), stiffness_per_area_(stiffness_per_area) {
    for (const auto& effect : effects_) needs_ |= effect->needs();
    if (!any(HapticEffect::kReadsContacts)) return;
    contacts_.resize(most_candidates);
    is_on_burr_.resize(most_candidates);
    rubbing_radius_.resize(most_candidates);
    place_area_.resize(most_candidates);
}

void EffectHost::restart(Restart why) noexcept {
    for (const auto& effect : effects_) effect->restart(why);
    tick_.contacts = {};
    tick_.is_on_burr = {};
    tick_.rubbing_radius = {};
    tick_.burr_load = {};
    tick_.cut_share = 1;
}

void EffectHost::begin(const EffectStart& start) noexcept {
    static_cast<EffectStart&>(tick_) = start;
    tick_.spin_speed = start.is_pedal_down ? start.tool->burr.speed : 0;
    tick_.axis_load = 0;
    for (const auto& effect : effects_) effect->begin(tick_);
}

double EffectHost::scale(Candidates& candidates, const Eigen::Vector3d& origin_V, const ToolField& tool,
                         const Pose& X_VT) noexcept {
    if (any(HapticEffect::kReadsContacts)) {
        const float area_per_weight = float(1 / stiffness_per_area_);
        for (size_t n = 0; n < candidates.count; ++n) place_area_[n] = area_per_weight * candidates.weight[n];
        tick_.place_area = {place_area_.data(), candidates.count};
        tick_.candidates = &candidates;
        burr_slack_ = burrSlack(tool);
    }
    double largest = 1;
    for (const auto& effect : effects_)
        if (effect->needs() & HapticEffect::kScales)
            largest *= effect->scale(tick_, candidates, origin_V, tool, X_VT);
    return largest;
}

EnergyTerm EffectHost::at(const Pose& X_VT) const noexcept {
    EnergyTerm sum;
    for (const auto& effect : effects_)
        if (effect->needs() & HapticEffect::kHasEnergy) sum += effect->energy(tick_, X_VT);
    return sum;
}

void EffectHost::addToHand(Wrench& wrench_V) noexcept {
    for (const auto& effect : effects_) effect->addToHand(tick_, wrench_V);
}

void EffectHost::afterSolve(const Pose& X_VT, SpoModel& model) noexcept {
    tick_.X_VT = X_VT;
    tick_.velocity_V = (X_VT.position - tick_.X_VT_start.position) / tick_.dt;
    tick_.angular_velocity_V = logRotation(X_VT.rotation * tick_.X_VT_start.rotation.conjugate()) / tick_.dt;
    if (!any(HapticEffect::kReadsContacts)) return;
    const size_t count = model.listContacts(contacts_);
    tick_.contacts = {contacts_.data(), count};
    tick_.is_on_burr = {is_on_burr_.data(), count};
    tick_.rubbing_radius = {rubbing_radius_.data(), count};
    // A contact lies inside the tool, so that those of the burr lie inside the burr but for what the tool's
    // distances may be wrong.
    const Eigen::Quaternionf R_TV = X_VT.rotation.conjugate().cast<float>();
    const Eigen::Vector3d axis = X_VT.rotation * Eigen::Vector3d::UnitY();
    for (size_t n = 0; n < count; ++n) {
        const SurfaceContact& contact = contacts_[n];
        const Eigen::Vector3f r_T = R_TV * contact.r_V;
        is_on_burr_[n] = tick_.tool->burr.signedDistance(r_T.cast<double>()) < burr_slack_;
        if (is_on_burr_[n])
            rubbing_radius_[n] =
                rubbingRadius(contact.r_V.cast<double>(), axis, double(place_area_[contact.candidate]));
    }
    tick_.burr_load = burrLoadOf(tick_);
}

void EffectHost::mill(BoneModel& bone, MillingResult& result) noexcept {
    for (const auto& effect : effects_) effect->mill(tick_, bone, result);
}

const EffectRecord& EffectHost::finish(bool has_time) noexcept {
    tick_.has_time = has_time;
    tick_.record = {};
    tick_.record.spin_speed = float(tick_.spin_speed);
    if (any(HapticEffect::kReadsContacts)) {
        const BurrLoad& load = tick_.burr_load;
        tick_.record.burr_force = float(load.force);
        tick_.record.cutting_power = float(frictionOf(tick_) * load.moment * std::abs(tick_.spin_speed));
    }
    for (const auto& effect : effects_) effect->finish(tick_);
    return tick_.record;
}

}  // namespace bonemill

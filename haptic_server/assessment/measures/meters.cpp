#include "haptic_server/assessment/measures/meters.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "haptic_server/assessment/measures/definitions.h"

namespace bonemill {

void Steadiness::add(const MotionSample& sample) noexcept {
    if (!sample.follows || sample.contact < 1) {
        axes_W_.setZero();
        force_ = force_squared_ = 0;
        count_ = 0;
    }
    if (sample.contact < 1) return;
    axes_W_ += sample.axis_W;
    force_ += sample.force;
    force_squared_ += sample.force * sample.force;
    if (++count_ == kSamples) endSecond();
}

// The angular deviation of directions is sqrt(-2 ln R), R the length of their mean.
void Steadiness::endSecond() noexcept {
    const double length = std::min(1.0, axes_W_.norm() / count_);
    axis_unrest_.add(std::sqrt(-2 * std::log(length)));
    const double mean = force_ / count_;
    force_unrest_.add(std::sqrt(std::max(0.0, force_squared_ / count_ - mean * mean)));
    axes_W_.setZero();
    force_ = force_squared_ = 0;
    count_ = 0;
}

void Steadiness::append(Figures& figures) const {
    put(figures, "steady.axis", axis_unrest_.median() / kDegree);
    put(figures, "steady.force", force_unrest_.median());
}

void StructureMeter::add(const TickStep& step) noexcept {
    const EffectRecord& effects = step.record.effects;
    if (Structure* nearest = of(effects.protected_id))
        nearest->distance = std::min(nearest->distance, double(effects.protected_distance));
    Structure* const touched = of(effects.touched_id);
    if (touched && (effects.events & kEventProtectedTouched))
        touched->force = std::max(touched->force, double(effects.protected_force));
    const double damaged = std::max(0.0, double(effects.damaged_volume) - damaged_);
    damaged_ = effects.damaged_volume;
    Structure* const hit = of(effects.damaged_id);
    if (!hit || !(effects.events & kEventProtectedDamaged)) return;
    if (step.t() - hit->last_damage_s > kEpisodeGap) ++hit->episodes;
    hit->last_damage_s = step.t();
    hit->damaged += damaged;
    hit->damage_time += step.dt;
}

// A structure that was never in reach was not cut: a gate may ask for that. How far it was is unknown.
void StructureMeter::append(Figures& figures) const {
    for (size_t id = 0; id < structures_.size(); ++id) {
        const Structure& structure = structures_[id];
        const bool was_in_reach = std::isfinite(structure.distance);
        if (!scene_.isProtected(id) && !was_in_reach && !structure.isTouched()) continue;
        const std::string& name = scene_.materials[id];
        put(figures, "damage.episodes", double(structure.episodes), name);
        put(figures, "damage.volume", structure.damaged * kPerCubicMillimetre, name);
        put(figures, "damage.time", structure.damage_time, name);
        put(figures, "structure.force", structure.force, name);
        if (was_in_reach) put(figures, "structure.distance", structure.distance * kPerMillimetre, name);
    }
}

void RemovalMeter::add(const TickStep& step) noexcept {
    const double removed = step.record.removed;
    removed_ += removed;
    friction_work_ += double(step.record.effects.cutting_power) * step.dt;
    addAngle(step);
    const size_t tool = step.record.tool;
    const bool is_near = step.distance() < kNear;
    if (is_near) near_removed_ += removed;
    if (tool >= of_.size()) return;
    of_[tool] += removed;
    if (is_near) near_of_[tool] += removed;
}

void RemovalMeter::add(const MotionSample& sample) noexcept {
    if (sample.removed > 0) cutting_ += MotionSample::kDt;
}

// The force on the hand points away from the bone, but for friction.
void RemovalMeter::addAngle(const TickStep& step) noexcept {
    const double force = step.force();
    if (!step.isInContact() || force < kMinForce) return;
    const double cosine = std::clamp(step.f_W().dot(step.axis_W()) / force, -1.0, 1.0);
    const double angle = std::acos(cosine) / kDegree;
    angle_.add(angle, step.dt);
    removed_with_direction_ += step.record.removed;
    if (angle > kSide) side_removed_ += step.record.removed;
}

void RemovalMeter::append(Figures& figures) const {
    const double mm3 = removed_ * kPerCubicMillimetre;
    put(figures, "removal.volume", mm3);
    put(figures, "removal.rate", mm3 / cutting_);
    if (scene_.recorded.burr) put(figures, "removal.friction_energy", friction_work_ / mm3);
    for (size_t tool = 0; tool < of_.size(); ++tool) {
        if (of_[tool] <= 0) continue;
        const std::string& name = scene_.tools[tool];
        put(figures, "burr.volume", of_[tool] * kPerCubicMillimetre, name);
        put(figures, "burr.share", 100 * of_[tool] / removed_, name);
        if (scene_.recorded.protection)
            put(figures, "burr.near_share", 100 * near_of_[tool] / near_removed_, name);
    }
    put(figures, "angle.normal", angle_.median());
    put(figures, "angle.side_share", 100 * side_removed_ / removed_with_direction_);
}

void ForceMeter::add(const TickStep& step) noexcept {
    if (!step.isInContact()) return;
    const double force = step.force();
    const size_t bin = DistanceBins::of(step.distance());
    in_contact_.add(force, step.dt);
    impulse_ += force * step.dt;
    force_at_[bin].add(force, step.dt);
    if (limit_ <= 0 || force <= limit_) return;
    excess_ += step.dt;
    excess_at_[bin] += step.dt;
}

void ForceMeter::add(const MotionSample& sample) noexcept {
    if (sample.follows && sample.contact >= 0.5)
        speed_at_[DistanceBins::of(sample.distance)].add(
            (sample.p_W - last_.p_W).norm() * MotionSample::kRate, MotionSample::kDt);
    last_ = sample;
}

void ForceMeter::append(Figures& figures) const {
    put(figures, "force.mean", in_contact_.mean());
    put(figures, "force.median", in_contact_.median());
    put(figures, "force.p95", in_contact_.quantile(0.95));
    put(figures, "force.max", in_contact_.max());
    put(figures, "force.impulse", impulse_);
    if (limit_ > 0) put(figures, "force.excess", 100 * excess_ / in_contact_.weight());
    if (!has_structures_) return;
    for (size_t bin = 0; bin < DistanceBins::kCount; ++bin) {
        const char* const name = DistanceBins::kNames[bin];
        put(figures, "near.time", force_at_[bin].weight(), name);
        put(figures, "near.force", force_at_[bin].median(), name);
        put(figures, "near.speed", speed_at_[bin].median() * kPerMillimetre, name);
        if (limit_ > 0) put(figures, "force.excess", 100 * excess_at_[bin] / force_at_[bin].weight(), name);
    }
}

}  // namespace bonemill

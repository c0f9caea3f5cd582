#include "haptic_server/assessment/measures/force_meter.h"

#include "common/base/units.h"
#include "haptic_server/assessment/measures/definitions.h"

namespace bonemill {

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

#include "haptic_server/assessment/measures/removal_meter.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "haptic_server/assessment/measures/definitions.h"

namespace bonemill {

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

}  // namespace bonemill

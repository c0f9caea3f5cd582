#include "haptic_server/assessment/measures/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace bonemill {
namespace {

constexpr double kSlotsPerSide = Motion::kHalfWidth * MotionSample::kRate;

double weightAt(double t) noexcept {
    const double x = 2 * std::numbers::pi * Motion::kCutOff * t;
    const double sinc = std::abs(x) < 1e-9 ? 1 : std::sin(x) / x;
    const double cosine = std::cos(0.5 * std::numbers::pi * t / Motion::kHalfWidth);
    return sinc * cosine * cosine;
}

}  // namespace

void Motion::add(const TickStep& step) {
    const double place = step.t() * MotionSample::kRate;
    const auto here = int64_t(std::llround(place));
    if (step.dt <= 0) {
        finish();
        next_ = last_ = here;
        has_begun_ = true;
        follows_ = false;
        return;
    }
    const auto first = std::max(next_, int64_t(std::ceil(place - kSlotsPerSide)));
    while (next_ < first) emit(next_++);
    const Eigen::Vector3d p_W = step.p_W(), axis_W = step.axis_W();
    for (int64_t number = first; number <= int64_t(std::floor(place + kSlotsPerSide)); ++number) {
        const double weight = weightAt(double(number) / MotionSample::kRate - step.t()) * step.dt;
        Slot& to = slot(number);
        to.weight += weight;
        to.p_W += weight * p_W;
        to.axis_W += weight * axis_W;
    }
    Slot& own = slot(here);
    own.time += step.dt;
    own.force_time += step.force() * step.dt;
    own.contact_time += step.isInContact() ? step.dt : 0;
    own.removed += step.record.removed;
    own.distance = std::min(own.distance, step.distance());
    last_ = here;
}

void Motion::finish() {
    if (!has_begun_) return;
    while (next_ <= last_) emit(next_++);
    slots_ = {};
    has_begun_ = false;
}

// A place is known where ticks ran.
void Motion::emit(int64_t number) {
    const Slot done = std::exchange(slot(number), Slot{});
    if (done.time <= 0 || done.weight <= 0) {
        follows_ = false;
        return;
    }
    MotionSample sample;
    sample.t = double(number) / MotionSample::kRate;
    sample.follows = std::exchange(follows_, true);
    sample.p_W = done.p_W / done.weight;
    const double norm = done.axis_W.norm();
    if (norm > 0) sample.axis_W = done.axis_W / norm;
    sample.force = done.force_time / done.time;
    sample.contact = done.contact_time / done.time;
    sample.removed = done.removed;
    sample.distance = done.distance;
    see_(sample);
}

}  // namespace bonemill

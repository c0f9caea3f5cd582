#include "haptic_server/assessment/measures/steadiness.h"

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

}  // namespace bonemill

#include "render_client/look/visual_effects/burr_spin.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kLongestExposure = 1.0 / 24;  // s: pictures that come slower are stills

}  // namespace

void BurrSpin::advance(double dt, double spin_speed) {
    angle_ = std::remainder(angle_ + spin_speed * dt, kTurn);
    swept_ += spin_speed * dt;
    time_ += dt;
}

BurrTurn BurrSpin::takeTurn() {
    if (time_ > 0) {
        turn_.angle = float(angle_);
        turn_.sweep = float(swept_ * std::min(1.0, kLongestExposure / time_));
        swept_ = time_ = 0;
    }
    return turn_;
}

}  // namespace bonemill

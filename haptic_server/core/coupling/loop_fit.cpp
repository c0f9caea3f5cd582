#include "haptic_server/core/coupling/loop_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "common/math/pinned_math.h"

namespace bonemill {
namespace {

// These are tried one after the other, the gentlest first; shares below the wished one are left out.
constexpr double kShares[] = {1, 1.5, 2, 3, 4, LoopFit::kLargestShare};
constexpr double kTimes[] = {4e-3, 2.5e-3, 1.5e-3, 1e-3};  // s
constexpr int kCandidates = 1 + int(std::size(kShares) * std::size(kTimes));
// Of the coupling's stiffness: from a wall to soft bone that is hardly touched, and free air.
constexpr double kWalls[] = {std::numeric_limits<double>::infinity(), 4, 1, 0.3, 0};
constexpr int kLoopsPerAdvance = 6;
constexpr double kMinStiffness = 1e-3;  // of the wish
constexpr double kStep = 0.92;          // from stiffness to stiffness
// A larger share is felt in the flicker of the encoders: it must be worth so much stiffness per unit.
constexpr double kShareIsWorth = 1.03;

}  // namespace

LoopFit::LoopFit(const HandleAxis& axis, const LoopSprings& wish, double most_quick, double dt) noexcept
    : axis_(axis), wish_(wish), best_(wish), most_quick_(most_quick), dt_(dt) {
    axis_.delay_s += kDelaySlack * dt;
    wish_.stiffness = std::min(wish.stiffness, most_quick / (1 + wish.relaxing_share));
    best_ = wish_;
    is_done_ = !(axis.inertia > 0 && wish_.stiffness > 0);
}

bool LoopFit::comesToRest(const HandleAxis& axis, const LoopSprings& springs, double dt) noexcept {
    int loops = 0;
    LoopFit fit;
    fit.axis_ = axis;
    fit.dt_ = dt;
    return fit.isStable(springs, loops);
}

bool LoopFit::isStable(const LoopSprings& springs, int& loops) const noexcept {
    for (const double wall : kWalls) {
        ++loops;
        const double stiffness = springs.stiffness * (std::isinf(wall) ? 1 : wall / (1 + wall));
        const double decay = kDampingRatio * std::sqrt(stiffness / axis_.inertia);
        if (growthPerTick(axis_, springs, wall, dt_) > pinned::exp(-decay * dt_)) return false;
    }
    return true;
}

LoopSprings LoopFit::shape() const noexcept {
    LoopSprings springs = wish_;
    if (candidate_ == 0) return springs;
    const int n = candidate_ - 1, times = int(std::size(kTimes));
    springs.relaxing_share = kShares[n / times];
    springs.relaxing_time = kTimes[n % times];
    springs.stiffness = std::min(wish_.stiffness, most_quick_ / (1 + springs.relaxing_share));
    return springs;
}

// A scene without the relaxing spring shall have none.
void LoopFit::nextShape() noexcept {
    do ++candidate_;
    while (candidate_ < kCandidates &&
           (wish_.relaxing_share == 0 || shape().relaxing_share <= wish_.relaxing_share * (1 - 1e-9)));
}

void LoopFit::advance() noexcept {
    for (int loops = 0; !is_done_ && loops < kLoopsPerAdvance;) loops += tryNext();
}

int LoopFit::tryNext() noexcept {
    if (is_softening_) return soften();
    int loops = 0;
    const LoopSprings springs = shape();
    if (springs.stiffness >= wish_.stiffness && isStable(springs, loops)) {
        best_ = springs;
        is_done_ = true;
        return loops;
    }
    nextShape();
    if (candidate_ < kCandidates) return loops;
    is_softening_ = true;
    candidate_ = 0;
    tried_ = shape().stiffness;
    return loops;
}

// What is stable at one stiffness need not be so at every lower one: nothing is left out on the way down.
int LoopFit::soften() noexcept {
    int loops = 0;
    LoopSprings springs = shape();
    springs.stiffness = tried_;
    tried_ *= kStep;
    const double least =
        std::max(kMinStiffness * wish_.stiffness,
                 found_ * pinned::pow(kShareIsWorth, springs.relaxing_share - best_.relaxing_share));
    const bool is_worth_it = springs.stiffness > least;
    if (is_worth_it && !isStable(springs, loops)) return loops;
    if (is_worth_it) {
        best_ = springs;
        found_ = springs.stiffness;
    }
    nextShape();
    is_done_ = candidate_ >= kCandidates;
    if (!is_done_)
        tried_ = shape().stiffness;
    else if (found_ == 0)
        best_.stiffness = kMinStiffness * wish_.stiffness;
    return loops;
}

}  // namespace bonemill

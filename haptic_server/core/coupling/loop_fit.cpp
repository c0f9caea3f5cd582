#include "haptic_server/core/coupling/loop_fit.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "common/math/pinned_math.h"

namespace bonemill {
namespace {

// The states are place and speed of the handle, force of the amplifier, tool's lag behind the handle,
// what the relaxing spring follows, and the forces on their way.
enum State { kPlace, kSpeed, kForce, kLag, kFollowed, kPipe };
constexpr int kMaxDelay = 7;
constexpr int kMaxStates = kPipe + kMaxDelay + 1;
using LoopMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxStates, kMaxStates>;
using LoopRow = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMaxStates>;

// The device under a force that is held: (place, speed, force, command), exact by scaling and squaring.
Eigen::Matrix4d heldFor(const HandleAxis& axis, double time) noexcept {
    constexpr int kHalvings = 10, kTerms = 6;
    const double pole = 1 / std::max(axis.amplifier_s, 1e-6);
    Eigen::Matrix4d rate = Eigen::Matrix4d::Zero();
    rate(kPlace, kSpeed) = 1;
    rate(kSpeed, kSpeed) = -axis.damping / axis.inertia;
    rate(kSpeed, kForce) = 1 / axis.inertia;
    rate(kForce, kForce) = -pole;
    rate(kForce, 3) = pole;
    rate *= time / (1 << kHalvings);
    Eigen::Matrix4d result = Eigen::Matrix4d::Identity();
    for (int n = kTerms; n > 0; --n) result = (Eigen::Matrix4d::Identity() + rate * result / n).eval();
    for (int n = 0; n < kHalvings; ++n) result = (result * result).eval();
    return result;
}

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

double growthPerTick(const HandleAxis& axis, const LoopSprings& springs, double wall, double dt) noexcept {
    const int whole = std::clamp(int(axis.delay_s / dt + 1e-9), 0, kMaxDelay - 1);
    const double part = std::clamp(axis.delay_s - whole * dt, 0.0, dt);
    const int pipe = whole + 1;
    const int states = kPipe + pipe;
    const double share = dt / (springs.relaxing_time + dt);
    const double k = springs.stiffness, k_2 = springs.relaxing_share * k * (1 - share);
    const double drag = springs.damping_time * k / dt;

    // The tool goes to where contact, springs and drag are in balance: its place as a row of the state.
    LoopRow lag = LoopRow::Zero(states);
    if (std::isinf(wall)) {
        lag[kPlace] = 1;
    } else {
        // In the tool's lag d behind the handle at x: wall (x - d) = k d + k_2 (d - d_f) - drag (x - d - x_s)
        const double all = wall * k + k + k_2 + drag;
        lag[kPlace] = wall * k / all;
        lag[kFollowed] = k_2 / all;
        lag[kLag] = drag / all;  // of the handle's place now against the tool's before
    }
    LoopRow push = -(k + k_2) * lag;
    push[kFollowed] += k_2;

    LoopMatrix A = LoopMatrix::Zero(states, states);
    // The command that arrives late in the tick: the older one acts for `part` of it.
    LoopRow older = LoopRow::Zero(states), newer = LoopRow::Zero(states);
    older[kPipe] = 1;
    if (whole == 0)
        newer = push;
    else
        newer[kPipe + 1] = 1;
    const Eigen::Matrix4d first = heldFor(axis, part), second = heldFor(axis, dt - part);
    LoopMatrix handle = LoopMatrix::Zero(3, states);
    handle.leftCols(3).setIdentity();
    for (const auto& [held, command] : {std::pair{&first, &older}, std::pair{&second, &newer}})
        handle = (held->topLeftCorner<3, 3>() * handle + held->topRightCorner<3, 1>() * *command).eval();
    A.topRows(3) = handle;
    // The next tick finds the tool at x - lag, so that against the new place it lags by the way of the handle
    // more.
    A.row(kLag) = lag + handle.row(kPlace);
    A(kLag, kPlace) -= 1;
    A.row(kFollowed) = share * lag;
    A(kFollowed, kFollowed) += 1 - share;
    for (int n = 0; n + 1 < pipe; ++n) A(kPipe + n, kPipe + n + 1) = 1;
    A.row(kPipe + pipe - 1) = push;
    if (wall == 0) {  // nothing pulls the handle to a place
        A.row(kPlace).setZero();
        A.col(kPlace).setZero();
    }
    // Same units for all: N.
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxStates, 1> scale(states);
    scale.setOnes();
    scale[kPlace] = scale[kLag] = scale[kFollowed] = k;
    scale[kSpeed] = std::sqrt(k * axis.inertia);
    A = (scale.asDiagonal() * A * scale.cwiseInverse().asDiagonal()).eval();

    // |A^(2^n)| / |A^(2^(n-1))| goes to the largest eigenvalue to the power 2^(n-1), much sooner than a root
    // of the one norm goes there.
    constexpr int kSquarings = 13;
    double log_size = 0, log_before = 0;
    for (int n = 0; n <= kSquarings; ++n) {
        const double size = A.norm();
        if (!std::isfinite(size)) return std::numeric_limits<double>::infinity();
        if (size < 1e-300) return 0;
        log_before = log_size;
        log_size = 2 * log_size + pinned::log(size);
        A = ((A / size) * (A / size)).eval();
    }
    return pinned::exp((log_size - log_before) / double(1 << (kSquarings - 1)));
}

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

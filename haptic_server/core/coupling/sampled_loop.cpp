#include "haptic_server/core/coupling/sampled_loop.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
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

}  // namespace bonemill

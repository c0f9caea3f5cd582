// The gradient law's solve: Gauss-Newton steps with what has been learnt of the curvature, within the limits
// of speed and candidates, as far as the energy falls.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/geometry/pose.h"
#include "haptic_server/core/equilibrium/gradient_model.h"

namespace bonemill {
namespace {

// Rotations are measured in this length, the size of handle and tool, so that the matrix's rows
// have one unit.
constexpr double kRotationLength = 0.03;  // m
constexpr double kSmallestReach = 1e-9;   // m: a shorter step is no step
constexpr double kShortestLesson = 1e-7;  // m: over a shorter one the forces change mostly by rounding
constexpr int kMaxCuts = 4;               // of a step that goes uphill
// m: a sweep gathers within this at least. Newton's steps, each a small part of the one before, find their
// candidates there; by themselves they would gather anew for every nanometre.
constexpr double kLeastSweepMargin = 10e-6;
// Point tests of each candidate: for one more look at the energy where the candidates are others now and at a
// step with all its cuts, and for the shortest sweep.
constexpr double kSweepRounding = 1e-6;  // m: more than a sweep allows for
constexpr size_t kTriesKept = kMaxCuts + 2, kLeastSweep = 2;
// One cut leaves so much of a step's length: one that goes deep into a hard wall must become short.
constexpr double kLongestCut = 0.5, kShortestCut = 0.05;
constexpr double kFirstLambda = 1e-2, kMaxLambda = 1e6;
// Rounding of the depths must not refuse a step. It makes this share of the energy, some 10 roundings each.
constexpr double kFloatNoise = 1e-6, kDoubleNoise = 1e-13;
// The rounding of a place is this share of the tool's reach.
constexpr double kFloatRounding = 1.2e-7, kDoubleRounding = 2.2e-16;
// Forces out of balance, N, and torques by kRotationLength.
constexpr double kBalance = 1e-4;          // less is balance
constexpr double kFelt = 0.05;             // less is not felt,
constexpr double kFeltBesideForce = 0.01;  // nor is this share of the contact's force

Vector6d rotationScale() noexcept {
    Vector6d scale;
    scale << 1, 1, 1, 1 / kRotationLength, 1 / kRotationLength, 1 / kRotationLength;
    return scale;
}

Pose moved(const Pose& X_VT, const Vector6d& step) noexcept {
    return X_VT.incremented(step.head<3>(), step.tail<3>());
}

// Returns the largest share of `step` that keeps so_far + step within `most`, or no farther out than it is.
double shareOf(double most, const Eigen::Vector3d& so_far, const Eigen::Vector3d& step) noexcept {
    if ((so_far + step).norm() <= most) return 1;
    const double outwards = so_far.dot(step), squared = step.squaredNorm();
    const double room = std::max(0.0, most * most - so_far.squaredNorm());
    return std::min(1.0, (std::sqrt(outwards * outwards + squared * room) - outwards) / squared);
}

// Returns the step from so_far to the place within `most` that is nearest to so_far + step.
Eigen::Vector3d within(double most, const Eigen::Vector3d& so_far, const Eigen::Vector3d& step) noexcept {
    const Eigen::Vector3d all = so_far + step;
    const double length = all.norm();
    return length <= most ? step : Eigen::Vector3d(most / length * all - so_far);
}

// Along a step the energy first falls by `slope` per share, and after `share` of it has risen by `rise`. This
// returns where the parabola through all that is lowest, but not before the deepest contact of then, which is
// deeper by `deeper` of the way, must have begun.
double shareAtMinimum(double slope, double share, double rise, double deeper) noexcept {
    const double at = slope * share * share / (2 * (rise + slope * share));
    const double contact = (1 - deeper) * share;
    return std::clamp(std::max(at, contact), kShortestCut * share, kLongestCut * share);
}

}  // namespace

double GradientModel::outOfBalance(const State& state) noexcept {
    return rotationScale().cwiseProduct(stacked(state.total.wrench)).norm();
}

Matrix6d GradientModel::scaledStiffness(const State& state) noexcept {
    const Vector6d scale = rotationScale();
    return scale.asDiagonal() * state.total.stiffness * scale.asDiagonal();
}

void GradientModel::learnFrom(const State& before, const State& after) noexcept {
    const Vector6d scale = rotationScale();
    const Vector6d step = between(before.X_VT, after.X_VT);
    if (reachOf(step) < kShortestLesson) return;
    curvature_.learn(step.cwiseQuotient(scale),
                     scale.cwiseProduct(stacked(before.total.wrench) - stacked(after.total.wrench)),
                     scaledStiffness(after));
}

// Solves (K + S + λ D) step = wrench in scaled rotations, Gauss-Newton with what has been learnt of the
// curvature if that has a lowest point; zero if the matrix cannot be factored.
Vector6d GradientModel::newtonStep(const State& state) const noexcept {
    const Vector6d scale = rotationScale();
    Matrix6d K = scaledStiffness(state);
    K.diagonal().head<3>().array() += lambda_ * coupling_.translation_stiffness;
    K.diagonal().tail<3>().array() +=
        lambda_ * coupling_.rotation_stiffness / (kRotationLength * kRotationLength);
    Eigen::LLT<Matrix6d> factors(K + curvature_.matrix());
    if (factors.info() != Eigen::Success) factors.compute(K);
    if (factors.info() != Eigen::Success) return Vector6d::Zero();
    const Vector6d scaled_wrench = scale.cwiseProduct(stacked(state.total.wrench));
    const Vector6d step = scale.cwiseProduct(factors.solve(scaled_wrench));
    return step.allFinite() ? step : Vector6d::Zero();
}

// Returns the step within the speed limits over the whole tick. A turn that has to be shorter leaves the
// translation what is best with that turn: a hand that turns too quickly does not hold the tool's place back.
Vector6d GradientModel::withinSpeed(const State& state, const Vector6d& newton,
                                    const Tick& tick) const noexcept {
    const Vector6d so_far = between(tick.X_VT_start, state.X_VT);
    const double most_turn = config_.max_angular_speed * dt_, most_move = config_.max_speed * dt_;
    Vector6d step = newton;
    step.tail<3>() = within(most_turn, so_far.tail<3>(), newton.tail<3>());
    if (step.tail<3>() != newton.tail<3>()) {
        const Matrix6d& K = state.total.stiffness;
        step.head<3>() = K.topLeftCorner<3, 3>().llt().solve(
            Eigen::Vector3d(state.total.wrench.force - K.topRightCorner<3, 3>() * step.tail<3>()));
    }
    step.head<3>() = within(most_move, so_far.head<3>(), Eigen::Vector3d(step.head<3>()));
    if (step == newton) return step;
    tick.out->is_motion_clamped = true;
    const bool is_downhill = step.allFinite() && stacked(state.total.wrench).dot(step) > 0;
    if (is_downhill) return step;
    return std::min(shareOf(most_turn, so_far.tail<3>(), newton.tail<3>()),
                    shareOf(most_move, so_far.head<3>(), newton.head<3>())) *
           newton;
}

// Limits the step to the speeds, then either to the sweep (continuous collision) or to the trust radius
// around the place where the candidates were gathered. There one factor scales the whole twist.
Vector6d GradientModel::limited(const State& state, const Vector6d& newton, const Tick& tick) noexcept {
    const Vector6d step = withinSpeed(state, newton, tick);
    const auto room = [&] { return contact_.margin() - reachOf(between(X_VT_gathered_, state.X_VT)); };
    if (reachOf(step) <= room()) return step;
    if (settings_.continuous_collision && canGatherAgain()) return swept(state, step, tick);
    if (room() < trustRadius() / 2 && canGatherAgain()) gather(state.X_VT, trustRadius(), *tick.out);
    if (reachOf(step) <= room()) return step;
    tick.out->is_motion_clamped = true;
    return step * std::max(0.0, room() / reachOf(step));
}

// Returns as much of a long step as the sweep finds free. Where so many points are near, as around a drill in
// its hole, that no time would be left to find where along the step the energy is lowest, it is cut to what
// needs no sweep.
Vector6d GradientModel::swept(const State& state, const Vector6d& step, const Tick& tick) noexcept {
    const double reach = reachOf(step), unswept = trustRadius() / 2 - kSweepRounding;
    gather(state.X_VT, std::max(std::min(kLeastSweepMargin, unswept), reach * (1 + 1e-9)), *tick.out);
    if (reach <= unswept) return step;  // no point can come so deep that the sweep would end
    const size_t kept = kTriesKept * contact_.candidateCount(), left = pointTestsLeft();
    if (left < kept + kLeastSweep * contact_.candidateCount()) {
        tick.out->is_motion_clamped = true;
        return unswept / reach * step;
    }
    const double share = contact_.advance(*field_, state.X_VT, step, trustRadius() / 2, left - kept);
    point_tests_ += contact_.takePointTests();
    return share * step;
}

// Returns whether what the step can gain is less than the rounding of the depths makes: a rise then says
// nothing, and parts of the step would be tried in vain. All points of a flat end round alike.
bool GradientModel::isLostInNoise(const State& state, const Vector6d& step) const noexcept {
    const bool is_double = settings_.precision == Precision::kDouble;
    const double of_depth = (is_double ? kDoubleRounding : kFloatRounding) * field_->reach();
    return stacked(state.total.wrench).dot(step) <= of_depth * state.contact_force;
}

// Takes the step, or a part of it for which the energy falls. False: there is no such part, the state stays.
bool GradientModel::moveDown(State& state, const Vector6d& step, const Tick& tick) noexcept {
    const double noise = settings_.precision == Precision::kDouble ? kDoubleNoise : kFloatNoise;
    const double slope = stacked(state.total.wrench).dot(step);
    double share = 1;
    for (int n = 0; n <= kMaxCuts && (n == 0 || pointTestsLeft() > 0); ++n) {
        const State next = evaluate(moved(state.X_VT, share * step), tick);
        if (next.isFinite() &&
            next.total.energy <= state.total.energy + noise * std::abs(state.total.energy)) {
            state = next;
            return true;
        }
        if (isLostInNoise(state, step)) return false;
        const double rise = next.total.energy - state.total.energy;
        const double deeper = (next.max_depth - state.max_depth) / reachOf(share * step);
        share = std::isfinite(rise) && slope > 0 ? shareAtMinimum(slope, share, rise, deeper)
                                                 : kLongestCut * share;
    }
    return false;
}

// A tool that has cut itself free does not feel the bone ahead of it, and its Newton step goes deep into it:
// it does better to begin with the last tick's motion. That is within the margin, and too short to tunnel.
void GradientModel::goOn(State& state, const Tick& tick) noexcept {
    if (!(last_reach_ > kSmallestReach && last_reach_ <= trustRadius() / 2)) return;
    if (state.contacts > 0) return;
    const Wrench& pull = state.total.wrench;
    Vector6d motion = last_motion_;
    if (pull.force.dot(motion.head<3>()) <= 0) motion.head<3>().setZero();
    if (pull.torque.dot(motion.tail<3>()) <= 0) motion.tail<3>().setZero();
    if (!motion.isZero(0) && reachOf(motion) < reachOf(newtonStep(state))) moveDown(state, motion, tick);
}

// Makes Gauss-Newton steps as long as they help and there is time. False: something is not finite, or a
// matrix has no factors; the state is the last good one.
bool GradientModel::descend(State& state, const Tick& tick) noexcept {
    if (!state.isFinite()) return false;
    for (int n = 0; n < settings_.iterations && outOfBalance(state) > kBalance; ++n) {
        const Vector6d newton = newtonStep(state);
        if (newton.isZero(0)) return stacked(state.total.wrench).isZero(0);
        const uint32_t gatherings = tick.out->gatherings;
        const Vector6d step = limited(state, newton, tick);
        if (reachOf(step) < kSmallestReach) {
            if (lambda_ == 0) break;
            lambda_ = 0;  // which may be what made it short
            continue;
        }
        if (tick.out->gatherings != gatherings)
            state = evaluate(state.X_VT, tick);  // the energy is that of other points now
        ++tick.out->iterations;
        const State before = state;
        const bool has_moved = moveDown(state, step, tick);
        if (has_moved) {
            learnFrom(before, state);
            lambda_ = lambda_ > kFirstLambda / 10 ? lambda_ / 10 : 0;
        } else if (!tryOtherwise(state, tick, n + 1 == settings_.iterations || !canLookAgain())) {
            break;
        }
        if (!canLookAgain()) {
            noteCutShort(state, tick);
            break;
        }
    }
    return true;
}

// The tick ends for want of time. That is worth coarser samples where it holds the tool, tick by tick; not
// where the tool goes on, or where the next tick makes it good.
void GradientModel::noteCutShort(const State& state, const Tick& tick) noexcept {
    const bool has_moved = reachOf(between(tick.X_VT_start, state.X_VT)) > kSmallestReach;
    is_cut_short_ = isFelt(state) && !(has_moved && tick.out->is_motion_clamped);
    tick.out->has_contact_overflow |= is_cut_short_ && (was_cut_short_ || !has_moved);
}

// Are the forces out of balance by more than a hand may miss?
bool GradientModel::isFelt(const State& state) noexcept {
    return outOfBalance(state) > std::max(kFelt, kFeltBesideForce * state.contact_force);
}

// After a step that led uphill: what was learnt may be to blame, or it was too long. False: this tick ends.
bool GradientModel::tryOtherwise(const State& state, const Tick& tick, bool is_last) noexcept {
    const bool has_learnt = !curvature_.isEmpty();
    curvature_.forget();
    if (has_learnt && !is_last) return true;
    if (!has_learnt) lambda_ = std::min(std::max(kFirstLambda, lambda_ * 10), kMaxLambda);
    tick.out->has_stalled = isFelt(state);
    return false;
}

}  // namespace bonemill

#include "haptic_server/spo/gradient_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

// Rotations are measured in this length, the size of handle and tool, so that the matrix's rows
// have one unit.
constexpr double kRotationLength = 0.03;  // m
constexpr double kSmallestReach = 1e-9;   // m: a shorter step is no step
constexpr double kShortestLesson =
    1e-7;                               // m: over a shorter step the change of the forces is mostly rounding
constexpr double kLeastMargin = 20e-6;  // m: what a hand moves in a millisecond when it works
constexpr double kMotionGrowth = 2;     // of the reach from tick to tick
constexpr int kMostCuts = 4;            // of a step that goes uphill
// One cut leaves so much of a step's length: one that goes deep into a hard wall must become short.
constexpr double kLongestCut = 0.5, kShortestCut = 0.05;
constexpr double kFirstLambda = 1e-2, kMostLambda = 1e6;
// Rounding of the depths must not refuse a step. It makes this share of the energy, some 10 roundings each.
constexpr double kFloatNoise = 1e-6, kDoubleNoise = 1e-13;
// The rounding of a place is this share of the tool's reach.
constexpr double kFloatRounding = 1.2e-7, kDoubleRounding = 2.2e-16;
// A new tool grows by this much per time, m/s, which the hand feels as less than its coupling times that,
// and only while it is not deeper in the bone than this share of its thinnest radius: squeezed more than that
// by a hole that is too narrow, it could not be drawn out.
constexpr double kGrowth = 0.01;
constexpr double kMostDepthToGrow = 0.05;
// Of the thinnest radius: where contact becomes so deep, and by so much deeper between two ticks in which the
// tool has not moved, bone has appeared in the tool.
constexpr double kDeepBone = GradientContact::kGuardFrom, kSuddenDepth = 0.2;
// Forces out of balance, N, and torques by kRotationLength: less is balance, and
constexpr double kBalance = 1e-4;
constexpr double kFelt = 0.05;             // less is not felt,
constexpr double kFeltBesideForce = 0.01;  // nor is this share of the contact's force
constexpr size_t kMostCandidates = 65'536;

Vector6d rotationScale() noexcept {
    Vector6d scale;
    scale << 1, 1, 1, 1 / kRotationLength, 1 / kRotationLength, 1 / kRotationLength;
    return scale;
}

Pose moved(const Pose& X_VT, const Vector6d& step) noexcept {
    return X_VT.incremented(step.head<3>(), step.tail<3>());
}

Vector6d stacked(const Wrench& wrench) noexcept {
    Vector6d w;
    w << wrench.force, wrench.torque;
    return w;
}

// Returns the share of `step` that keeps so_far + step within `most`.
double shareOf(double most, const Eigen::Vector3d& so_far, const Eigen::Vector3d& step) noexcept {
    if ((so_far + step).norm() <= most) return 1;
    return std::max(0.0, most - so_far.norm()) / step.norm();
}

// Along a step the energy first falls by `slope` per share, and after `share` of it has risen by `rise`. This
// returns where the parabola through all that is lowest, but not before the deepest contact of then, which is
// deeper by `deeper` of the way, must have begun.
double shareAtMinimum(double slope, double share, double rise, double deeper) noexcept {
    const double at = slope * share * share / (2 * (rise + slope * share));
    const double contact = (1 - deeper) * share;
    return std::clamp(std::max(at, contact), kShortestCut * share, kLongestCut * share);
}

Vector6d between(const Pose& X_VT_from, const Pose& X_VT_to) noexcept {
    Vector6d step;
    step << X_VT_to.position - X_VT_from.position,
        logRotation(X_VT_to.rotation * X_VT_from.rotation.conjugate());
    return step;
}

}  // namespace

bool GradientModel::State::isFinite() const noexcept {
    return std::isfinite(total.energy) && total.wrench.isFinite() && total.stiffness.allFinite() &&
           X_VT.isFinite();
}

GradientModel::GradientModel(const GradientConfig& config, const SpoWorld& world, const SpoTool& tool,
                             double dt)
    : config_(config),
      world_(world),
      tool_(tool),
      coupling_{config.coupling, tool.saturation_force},
      dt_(dt),
      field_(&tool_.model->field(settings_)),
      contact_(config.contact, std::min(kMostCandidates, config.most_point_tests / 4)),
      relaxing_(coupling_, dt) {
    setAccuracy(settings_);
}

void GradientModel::setAccuracy(const AccuracySettings& settings) noexcept {
    settings_ = settings;
    level_ = levelOf(world_.shell, settings);
    useTool();
    most_point_tests_ = size_t(double(config_.most_point_tests) / field_->testCost());
    contact_.limitCandidates(most_point_tests_ / 4);
    contact_.forget();
    curvature_.forget();
}

void GradientModel::setTool(const SpoTool& tool) noexcept {
    tool_ = tool;
    saturate();
    is_new_tool_ = true;
    setAccuracy(settings_);
}

void GradientModel::setCoupling(const EnergyCouplingConfig& coupling, double most_pull) noexcept {
    most_pull_ = most_pull;
    static_cast<EnergyCouplingConfig&>(coupling_) = coupling;
    saturate();
}

void GradientModel::saturate() noexcept {
    coupling_.saturation_force = std::min(tool_.saturation_force, most_pull_);
    relaxing_.setCoupling(coupling_);
    lambda_ = 0;
}

void GradientModel::setEffects(ContactWeights* weights, SolveEnergy* energy) noexcept {
    contact_.setWeights(weights);
    effects_ = energy;
}

size_t GradientModel::listContacts(std::span<SurfaceContact> out) noexcept {
    return contact_.list(*field_, X_VT_end_, out);
}

void GradientModel::useTool() noexcept {
    const ToolField& whole = tool_.model->field(settings_);
    growing_.setWhole(whole);
    field_ = growing_.offset() > 0 ? static_cast<const ToolField*>(&growing_) : &whole;
}

// Makes the new tool so much smaller that it is not deeper in the bone than the last one was. A tool whose
// surroundings are inside of it would otherwise find its way on into the solid bone, where there is no
// surface to push it back.
void GradientModel::fitTool(const Tick& tick) noexcept {
    is_new_tool_ = false;
    growing_.setOffset(0);
    useTool();
    gather(tick.X_VT_start, kLeastMargin, *tick.out);
    makeRoom(evaluate(tick.X_VT_start, tick).max_depth);
}

// Makes the tool, which is so deep in the bone, so much smaller that it is not deeper than in the last tick.
void GradientModel::makeRoom(double depth) noexcept {
    growing_.setOffset(growing_.offset() + depth - last_depth_);
    useTool();
    contact_.forget();
}

// Bone begins to count all at once for a tool whose middle comes out of it: out of the solid, or off a
// needle. Felt whole it would throw the tool out, as far as its radius and as fast as it may move.
bool GradientModel::hasBoneAppeared(const State& state) const noexcept {
    const double thinnest = growing_.whole().thinnestRadius();
    return knows_depth_ && state.max_depth > kDeepBone * thinnest &&
           state.max_depth > last_depth_ + kSuddenDepth * thinnest;
}

// Returns the state before the first step.
GradientModel::State GradientModel::begin(const Tick& tick) noexcept {
    is_new_tool_ ? fitTool(tick) : growTool();
    // What the last tick moved is a good guess of what this one will; a longer step gathers anew.
    const double margin = std::min(trustRadius(), std::max(kLeastMargin, kMotionGrowth * last_reach_));
    gather(tick.X_VT_start, margin, *tick.out);
    const State state = evaluate(tick.X_VT_start, tick);
    if (!hasBoneAppeared(state)) return state;
    makeRoom(state.max_depth);
    gather(tick.X_VT_start, margin, *tick.out);
    return evaluate(tick.X_VT_start, tick);
}

void GradientModel::growTool() noexcept {
    if (growing_.offset() == 0 || last_depth_ > kMostDepthToGrow * growing_.whole().thinnestRadius()) return;
    growing_.setOffset(growing_.offset() - kGrowth * dt_);
    useTool();
}

void GradientModel::restart() noexcept {
    way_.forget();
    relaxing_.forget();
    contact_.forget();
    curvature_.forget();
    lambda_ = 0;
    last_motion_.setZero();
    last_reach_ = 0;
    is_new_tool_ = false;
    last_depth_ = 0;
    knows_depth_ = false;
    useTool();
}

// Halved every tick, what is left of an old motion would end in subnormal numbers, which are slow.
void GradientModel::dropTraces(SpoStep& step) noexcept {
    constexpr double kTraceOfForce = 1e-12, kTraceOfTorque = 1e-15, kTraceOfRotation = 1e-20;
    const auto drop = [](auto&& values, double trace) {
        values = (values.array().abs() < trace).select(0, values.array()).matrix().eval();
    };
    drop(step.wrench_hand_V.force, kTraceOfForce);
    drop(step.wrench_hand_V.torque, kTraceOfTorque);
    drop(step.X_VT.rotation.coeffs(), kTraceOfRotation);
}

double GradientModel::trustRadius() const noexcept {
    return 0.5 * std::min(tool_.burr.radius, field_->thinnestRadius());
}

double GradientModel::reachOf(const Vector6d& step) const noexcept {
    return step.head<3>().norm() + step.tail<3>().norm() * field_->reach();
}

void GradientModel::gather(const Pose& X_VT, double margin, SpoStep& out) noexcept {
    ++gatherings_;
    X_VT_gathered_ = X_VT;
    const ShellView bone{world_.volume, world_.lattice,           world_.shell,
                         level_,        settings_.sample_spacing, settings_.most_samples};
    out.has_contact_overflow |= !contact_.gather(bone, *field_, X_VT, margin, pointTestsLeft());
    out.has_fewer_samples |= contact_.hasFewerSamples();
    out.candidates = uint32_t(contact_.candidateCount());
    point_tests_ += contact_.takePointTests();
}

GradientModel::State GradientModel::evaluate(const Pose& X_VT, const Tick& tick) noexcept {
    const GradientContactResult contact = settings_.precision == Precision::kDouble
                                              ? contact_.evaluate<double>(*field_, X_VT)
                                              : contact_.evaluate<float>(*field_, X_VT);
    point_tests_ += contact_.candidateCount();
    State state{X_VT, contact.term, 0, contact.contacts, contact.max_depth, contact.term.wrench.force.norm()};
    state.total += couplingEnergy(coupling_, X_VT, tick.X_VT_device, way_);
    state.total += relaxing_.energy(X_VT, tick.X_VT_device);
    state.stored = state.total.energy;
    state.total += dampingEnergy(coupling_, X_VT, tick.X_VT_start, dt_);
    if (effects_) state.total += effects_->at(X_VT);
    return state;
}

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
    const double turn = shareOf(config_.max_angular_speed * dt_, so_far.tail<3>(), newton.tail<3>());
    Vector6d step = newton;
    if (turn < 1) {
        const Matrix6d& K = state.total.stiffness;
        step.tail<3>() *= turn;
        step.head<3>() = K.topLeftCorner<3, 3>().llt().solve(
            Eigen::Vector3d(state.total.wrench.force - K.topRightCorner<3, 3>() * step.tail<3>()));
    }
    const double move = shareOf(config_.max_speed * dt_, so_far.head<3>(), step.head<3>());
    step.head<3>() *= move;
    tick.out->is_motion_clamped |= turn < 1 || move < 1;
    const bool is_downhill = step.allFinite() && stacked(state.total.wrench).dot(step) > 0;
    return is_downhill ? step : Vector6d(std::min(turn, move) * newton);
}

// Limits the step to the speeds, then either to the sweep (continuous collision) or to the trust radius
// around the place where the candidates were gathered. There one factor scales the whole twist.
Vector6d GradientModel::limited(const State& state, const Vector6d& newton, const Tick& tick) noexcept {
    const Vector6d step = withinSpeed(state, newton, tick);
    const auto room = [&] { return contact_.margin() - reachOf(between(X_VT_gathered_, state.X_VT)); };
    if (reachOf(step) <= room()) return step;
    if (settings_.continuous_collision && pointTestsLeft() > 0) {
        gather(state.X_VT, reachOf(step) * (1 + 1e-9), *tick.out);
        const double share = contact_.advance(*field_, state.X_VT, step, trustRadius() / 2, pointTestsLeft());
        point_tests_ += contact_.takePointTests();
        return share * step;
    }
    if (room() < trustRadius() / 2 && pointTestsLeft() > 0) gather(state.X_VT, trustRadius(), *tick.out);
    if (reachOf(step) <= room()) return step;
    tick.out->is_motion_clamped = true;
    return step * std::max(0.0, room() / reachOf(step));
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
    for (int n = 0; n <= kMostCuts && (n == 0 || pointTestsLeft() > 0); ++n) {
        const State next = evaluate(moved(state.X_VT, share * step), tick);
        if (next.isFinite() && next.total.energy <= state.total.energy * (1 + noise)) {
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
        const uint32_t gatherings = gatherings_;
        const Vector6d step = limited(state, newton, tick);
        if (reachOf(step) < kSmallestReach) {
            if (lambda_ == 0) break;
            lambda_ = 0;  // which may be what made it short
            continue;
        }
        if (gatherings_ != gatherings)
            state = evaluate(state.X_VT, tick);  // the energy is that of other points now
        ++tick.out->iterations;
        const State before = state;
        const bool has_moved = moveDown(state, step, tick);
        if (pointTestsLeft() == 0) {
            tick.out->has_contact_overflow = true;
            break;
        }
        if (has_moved) {
            learnFrom(before, state);
            lambda_ = lambda_ > kFirstLambda / 10 ? lambda_ / 10 : 0;
        } else if (!tryOtherwise(state, tick)) {
            break;
        }
    }
    return true;
}

// After a step that led uphill: what was learnt may be to blame, or it was too long. False: this tick ends.
bool GradientModel::tryOtherwise(const State& state, const Tick& tick) noexcept {
    if (!curvature_.isEmpty()) {
        curvature_.forget();
        return true;
    }
    lambda_ = std::min(std::max(kFirstLambda, lambda_ * 10), kMostLambda);
    tick.out->has_stalled = outOfBalance(state) > std::max(kFelt, kFeltBesideForce * state.contact_force);
    return false;
}

SpoStep GradientModel::advance(const Pose& X_VT, const Pose& X_VT_device) noexcept {
    SpoStep out;
    const Tick tick{X_VT, X_VT_device, &out};
    point_tests_ = 0;
    State state = begin(tick);
    goOn(state, tick);
    out.is_solved = descend(state, tick);
    X_VT_end_ = state.X_VT;
    last_motion_ = between(tick.X_VT_start, state.X_VT);
    last_reach_ = reachOf(last_motion_);
    energy_ = state.total.energy;
    out.stored_energy = state.stored;
    out.contacts = state.contacts;
    out.budget_share = double(point_tests_) / double(most_point_tests_);
    out.max_penetration = state.max_depth;
    last_depth_ = state.max_depth;
    knows_depth_ = true;
    feel(state.X_VT, tick);
    return out;
}

// Tells the pose, and what the hand gets of it.
void GradientModel::feel(const Pose& X_VT, const Tick& tick) noexcept {
    tick.out->X_VT = X_VT;
    tick.out->wrench_hand_V = couplingWrenchOnDevice(coupling_, X_VT, tick.X_VT_device, way_) +
                              relaxing_.wrenchOnDevice(X_VT, tick.X_VT_device);
    dropTraces(*tick.out);
    relaxing_.follow(X_VT, tick.X_VT_device);
    way_.remember(tick.X_VT_device.rotation * X_VT.rotation.conjugate());
}

}  // namespace bonemill

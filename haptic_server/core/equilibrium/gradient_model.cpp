#include "haptic_server/core/equilibrium/gradient_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/geometry/pose.h"

namespace bonemill {
namespace {

constexpr double kMinMargin = 20e-6;  // m: what a hand moves in a millisecond when it works
constexpr double kMotionGrowth = 2;   // of the reach from tick to tick
// A new tool grows by this much per time, m/s, which the hand feels as less than its coupling times that,
// and only while it is not deeper in the bone than this share of its thinnest radius: squeezed more than that
// by a hole that is too narrow, it could not be drawn out.
constexpr double kGrowth = 0.01;
constexpr double kMaxDepthToGrow = 0.05;
// Of the thinnest radius: where contact becomes so deep, and by so much deeper between two ticks in which the
// tool has not moved, bone has appeared in the tool.
constexpr double kDeepBone = GradientContact::kGuardFrom, kSuddenDepth = 0.2;
// m/s: at this speed the tool's damping would take all that it may be pulled with.
constexpr double kSpeedHeldBack = 0.4;
constexpr size_t kMaxCandidates = 65'536;

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
      wished_(config.coupling),
      coupling_{config.coupling, tool.saturation_force},
      dt_(dt),
      field_(&tool_.model->field(settings_)),
      contact_(config.contact, std::min(kMaxCandidates, config.most_point_tests / 4)),
      relaxing_(coupling_, dt) {
    saturate();
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

void GradientModel::setCoupling(const SpoCoupling& coupling) noexcept {
    most_pull_ = coupling.most_pull;
    saturation_force_ = coupling.saturation_force;
    wished_ = coupling.energy;
    relaxing_.stretch(coupling.stretched);
    saturate();
}

// What was learnt of the curvature is in the units of the stiffness.
void GradientModel::setContact(const GradientContactConfig& contact) noexcept {
    config_.contact = contact;
    contact_.setStiffness(contact);
    curvature_.forget();
}

void GradientModel::saturate() noexcept {
    const double most = std::min(saturation_force_.value_or(tool_.saturation_force), most_pull_);
    coupling_ = {wished_, most};
    coupling_.damping_time =
        std::min(wished_.damping_time, most / (kSpeedHeldBack * wished_.translation_stiffness));
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
    gather(tick.X_VT_start, kMinMargin, *tick.out);
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
    const double margin = std::min(trustRadius(), std::max(kMinMargin, kMotionGrowth * last_reach_));
    gather(tick.X_VT_start, margin, *tick.out);
    const State state = evaluate(tick.X_VT_start, tick);
    if (!hasBoneAppeared(state)) return state;
    makeRoom(state.max_depth);
    gather(tick.X_VT_start, margin, *tick.out);
    return evaluate(tick.X_VT_start, tick);
}

void GradientModel::growTool() noexcept {
    if (growing_.offset() == 0 || last_depth_ > kMaxDepthToGrow * growing_.whole().thinnestRadius()) return;
    growing_.setOffset(growing_.offset() - kGrowth * dt_);
    contact_.noteGrowth(kGrowth * dt_);
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
    is_new_tool_ = is_new_tool_ || isToolGrowing();
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
    ++out.gatherings;
    X_VT_gathered_ = X_VT;
    // Further gatherings of a tick look farther, and have more samples for once; a quick tool soon has other
    // patches near.
    const bool may_coarsen = out.gatherings == 1 && margin <= 2 * GradientContact::kFineWithin;
    const ShellView bone{
        world_.volume,          world_.lattice,      world_.shell, level_, settings_.sample_spacing,
        settings_.most_samples, affordable_samples_, may_coarsen};
    out.has_contact_overflow |= !contact_.gather(bone, *field_, X_VT, margin, pointTestsLeft());
    out.has_fewer_samples |= contact_.hasFewerSamples();
    out.candidates = uint32_t(contact_.candidateCount());
    gathering_tests_ = contact_.takePointTests();
    point_tests_ += gathering_tests_;
}

GradientModel::State GradientModel::evaluate(const Pose& X_VT, const Tick& tick) noexcept {
    const GradientContactResult contact = settings_.precision == Precision::kDouble
                                              ? contact_.evaluate<double>(*field_, X_VT)
                                              : contact_.evaluate<float>(*field_, X_VT);
    point_tests_ += contact_.candidateCount();
    State state{.X_VT = X_VT,
                .total = contact.term,
                .contacts = contact.contacts,
                .max_depth = contact.max_depth,
                .contact_force = contact.term.wrench.force.norm()};
    state.total += couplingEnergy(coupling_, X_VT, tick.X_VT_device, way_);
    state.total += relaxing_.energy(X_VT, tick.X_VT_device);
    state.stored = state.total.energy;
    state.total += dampingEnergy(coupling_, X_VT, tick.X_VT_start, dt_);
    if (effects_) {
        const EnergyTerm effects = effects_->at(X_VT);
        state.total += effects;
        state.effects = effects.wrench;
    }
    return state;
}

SpoStep GradientModel::advance(const Pose& X_VT, const Pose& X_VT_device) noexcept {
    SpoStep out;
    const Tick tick{X_VT, X_VT_device, &out};
    point_tests_ = 0;
    was_cut_short_ = std::exchange(is_cut_short_, false);
    State state = begin(tick);
    const Wrench effects_at_start = state.effects;
    goOn(state, tick);
    out.is_solved = descend(state, tick);
    X_VT_end_ = state.X_VT;
    last_motion_ = between(tick.X_VT_start, state.X_VT);
    last_reach_ = reachOf(last_motion_);
    energy_ = state.total.energy;
    out.stored_energy = state.stored;
    out.effects_work = stacked(effects_at_start + state.effects).dot(last_motion_) / 2;
    out.contacts = state.contacts;
    out.budget_share = double(point_tests_) / double(most_point_tests_);
    out.max_penetration = state.max_depth;
    out.is_tool_growing = isToolGrowing();
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

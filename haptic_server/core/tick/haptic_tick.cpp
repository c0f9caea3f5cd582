#include "haptic_server/core/tick/haptic_tick.h"

#include <cmath>
#include <utility>

#include "common/base/assert.h"
#include "common/rt/rt_guard.h"

namespace bonemill {
namespace {

template <class Number, size_t N, class Vector>
void copyTo(Number (&out)[N], const Vector& v) noexcept {
    for (size_t i = 0; i < N; ++i) out[i] = v[Eigen::Index(i)];
}

Eigen::Vector4d wxyz(const Eigen::Quaterniond& q) noexcept {
    return {q.w(), q.x(), q.y(), q.z()};
}

constexpr double kQuaternionNormSlack = 1e-2;
// New settings are prepared beside the old ones' work, after the force went out. A leaf of 16³ cells that is
// full of surface takes some 0.1 ms, a thesis' leaf of 32³ up to 0.4 ms. Only leaves that were milled or
// restored since are stale.
constexpr int kLeavesPreparedPerTick = 1;

Eigen::Vector3d middleOf(const VoxelVolume& volume) noexcept {
    return 0.5 * volume.spacing().cwiseProduct(volume.dims().cast<double>());
}

}  // namespace

HapticTick::HapticTick(const TickConfig& config, const TickBone& bone, const TickChoices& choices)
    : config_(config),
      bone_(bone.model),
      history_(bone.history),
      tools_(choices.tools),
      accuracy_(choices.accuracy),
      tunings_(choices.tuning),
      tool_(tools_.chosen()),
      models_(config.laws, {config.contact,
                            config.coupling,
                            config.gradient,
                            {bone_.volume, bone_.lattice, bone_.shell},
                            tools_.all(),
                            tools_[tool_],
                            config.dt}),
      model_(&models_.of(accuracy_.chosen().law)),
      affordable_preset_(config.dt),
      affordable_(config.dt),
      sample_cap_(config.dt),
      later_work_(config.dt),
      effects_(makeEffects(config.effects, bone_,
                           {config.dt, tools_.largestBurrRadius(), tools_.largestBurrReach(),
                            models_.mostCandidates(), config.most_milled_cells,
                            config.gradient.max_speed * config.dt * (1 + LaterWork::kMostWaits)}),
               models_.mostCandidates(), config.gradient.contact.stiffness_per_area),
      hand_limits_(config.hand, handSideOf(config).spring, config.dt),
      hand_coupling_(config_),
      X_WV_(bone_.volume.geometry().X_WV),
      X_VW_(X_WV_.inverse()),
      place_(middleOf(bone_.volume), config.hand_space, config.dt) {
    BONEMILL_ASSERT(config.dt > 0 && config.most_milled_cells > 0);
    const AccuracySettings& settings = accuracy_.chosen();
    bone_.shell.prepare(bone_.volume, bone_.lattice, levelOf(bone_.shell, settings),
                        int(bone_.lattice.leafCount()));
    models_.forEach([&](SpoModel& model) { model.setEffects(effects_.weights(), effects_.energy()); });
    takeUp(settings);
}

// A choice is taken up when its contact points are up to date; until then the old one stays in force.
void HapticTick::chooseSettings(SpoStep step, uint32_t& faults) noexcept {
    PointShell& shell = bone_.shell;
    const AccuracySettings& wished = accuracy_[decisions_.accuracy];
    AccuracySettings chosen = affordable_preset_.settings(wished, step);
    if (chosen != wished) faults |= AffordablePreset::faultOf(chosen);
    const int asked_for = chosen.shell_factor;
    chosen.shell_factor = affordable_.factor(shell, asked_for, settings_.shell_factor, step);
    if (chosen.shell_factor > asked_for) faults |= kFaultCoarserShell;
    if (chosen == settings_) return shell.follow(shell.followed());  // not even the one being prepared
    const auto [is_ready, is_complete] =
        shell.prepare(bone_.volume, bone_.lattice, levelOf(shell, chosen), kLeavesPreparedPerTick);
    if (!is_complete) faults |= kFaultShellOverflow;
    if (!is_ready) return;
    noteSuddenChange(SuddenChange::kSettings);
    takeUp(chosen);
}

void HapticTick::takeUp(const AccuracySettings& settings) noexcept {
    settings_ = settings;
    bone_.shell.follow(levelOf(bone_.shell, settings));
    SpoModel* model = &models_.of(settings.law);
    model->setAccuracy(settings);
    if (model != model_) {
        model->restart();
        effects_.restart(Restart::kOtherLaw);
    }
    model_ = model;
}

// The force comes at a limited rate, and the account of energy begins anew. Two changes leave the account as
// it is. The pedal softens the contact by what a tick cuts: µJ, of a tank of 1 mJ, which is not to be filled
// by playing the pedal. While a tool grows no account is kept anyway.
void HapticTick::noteSuddenChange(SuddenChange why) noexcept {
    hand_limits_.beginSuddenChange();
    if (why != SuddenChange::kPedal && why != SuddenChange::kToolGrows) has_changed_suddenly_ = true;
}

void HapticTick::adaptTo(const DeviceCapabilities& device) noexcept {
    hand_coupling_.adaptTo(device);
    estimate_ = HandEstimate(device.handle, hand_coupling_.side().spring, config_.hand_space, config_.dt);
    useCoupling();
}

void HapticTick::useCoupling() noexcept {
    const HandSide& side = hand_coupling_.side();
    SpoCoupling coupling{side.thesis, side.gradient, side.most_pull, hand_coupling_.stretched()};
    if (tuning_ != TuningSwitch::kOfScene)
        coupling.saturation_force = (*tunings_)[tuning_].saturation_forces[tool_];
    models_.forEach([&](SpoModel& model) { model.setCoupling(coupling); });
    hand_limits_.setDevice(side.limits, side.spring);
}

// The account begins anew whenever something else than hand and tool changes what is stored.
void HapticTick::keepAccount(const SpoStep& step, const DeviceInput& input) noexcept {
    const bool is_felt = !place_.isLost() && !input.is_stale && input.device.isEngaged();
    const bool says_something = is_felt && model_->traits().has_energy && !step.is_tool_growing &&
                                !std::exchange(has_changed_suddenly_, false);
    if (says_something ? hand_coupling_.takeAccount(X_VT_device_, step, was_pedal_down_ || was_add_wanted_)
                       : hand_coupling_.passOver())
        useCoupling();
}

// What other threads say is asked for once in a tick, so that the tick can be run again with the same.
void HapticTick::decide(const DeviceInput& input) noexcept {
    if (input.decisions) {
        decisions_ = *input.decisions;
        return;
    }
    decisions_.tool = uint32_t(tools_.chosen());
    decisions_.accuracy = uint32_t(accuracy_.choice());
    decisions_.tuning = tunings_ ? tunings_->chosen() : TuningSwitch::kOfScene;
    decisions_.is_milling_paused = history_ && history_->isMillingPaused();
    decisions_.milling_thrift = uint8_t(later_work_.millingThrift());
    decisions_.is_write_refused = decisions_.is_milling_put_off = decisions_.is_heat_put_off = false;
    decisions_.bone_order = history_ ? history_->takenUpOrder() : 0;
}

void HapticTick::chooseTool() noexcept {
    const size_t chosen = decisions_.tool;
    if (chosen == tool_) return;
    tool_ = chosen;
    unmilled_periods_ = 0;
    models_.forEach([&](SpoModel& model) { model.setTool(tools_[tool_]); });
    effects_.restart(Restart::kOtherTool);
    noteSuddenChange(SuddenChange::kTool);
    if (tuning_ != TuningSwitch::kOfScene) useCoupling();  // which is another tool's
}

void HapticTick::tune() noexcept {
    if (decisions_.tuning == tuning_ || !tunings_) return;
    tuning_ = decisions_.tuning;
    const TickTuning& tuning = (*tunings_)[tuning_];
    config_.coupling = tuning.thesis;
    config_.gradient.coupling = tuning.gradient;
    config_.gradient.contact = tuning.contact;
    config_.hand = tuning.hand;
    models_.forEach([&](SpoModel& model) { model.setContact(tuning.contact); });
    effects_.setStiffness(tuning.contact.stiffness_per_area);
    hand_coupling_.beginAnew();
    useCoupling();
    noteSuddenChange(SuddenChange::kSettings);
}

const TickRecord* HapticTick::tick(TickIo& io) noexcept {
    DeviceInput input;
    if (!io.read(input)) return nullptr;
    const RtScope scope;
    uint32_t faults = input.faults | (input.is_stale ? kFaultStaleDevice : kFaultNone);
    decide(input);
    if (input.other_device) adaptTo(*input.other_device);
    acceptPose(input, faults);
    chooseTool();
    tune();
    beginEffects(input);
    const SpoStep step = moveAndFeel(input, faults);
    const int64_t force_at_ns = io.write(step.wrench_hand_V.rotatedBy(X_WV_.rotation));
    estimate_.sent(input.device.isEngaged() ? step.wrench_hand_V : Wrench{});

    effects_.afterSolve(X_VT_, *model_);
    const MillingResult milled = mill(input, io, faults);
    keepWaiting(step);
    const EffectRecord& effects = finishEffects(input, io);
    chooseSettings(step, faults);
    TickRecord& record = record_ = makeRecord(input, step);
    was_bone_taken_ = !milled.changed.isEmpty() && !was_add_wanted_;
    record.removed_voxels = milled.removed_voxels;
    record.added_voxels = milled.added_voxels;
    record.removed = milled.removed_voxels * bone_.volume.voxelVolume();
    record.added = milled.added_voxels * bone_.volume.voxelVolume();
    record.cut = cutOf(milled.changed, input.start_ns);
    record.effects = effects;
    record.force_ns = force_at_ns - input.start_ns;
    const int64_t end_ns = io.now();
    record.compute_ns = end_ns - input.start_ns;
    if (end_ns > input.deadline_ns) faults |= kFaultOverrun;
    capSamples(input, {.whole = input.shareGone(end_ns),
                       .force = input.shareGone(force_at_ns),
                       .samples = step.candidates,
                       .is_work_put_off = decisions_.is_milling_put_off});
    record.faults = faults;
    record.input = recordedInput(input, decisions_);
    latched_faults_ |= faults;
    ++tick_;
    return &record;
}

// The clock decides that; a replay has it from then.
void HapticTick::capSamples(const DeviceInput& input, const TickLoad& load) noexcept {
    if (!input.decisions) {
        sample_cap_.after(load);
        decisions_.most_samples = sample_cap_.most() < UINT32_MAX ? uint32_t(sample_cap_.most()) : 0;
    }
    if (decisions_.most_samples == std::exchange(most_samples_, decisions_.most_samples)) return;
    const size_t most = most_samples_ == 0 ? SIZE_MAX : size_t(most_samples_);
    models_.forEach([&](SpoModel& model) { model.setAffordableSamples(most); });
}

void HapticTick::acceptPose(const DeviceInput& input, uint32_t& faults) noexcept {
    const bool is_first = !place_.hasPose();
    const bool is_placed = !is_first && std::exchange(placements_, input.placements) != input.placements;
    if (is_first) placements_ = input.placements;
    if (is_placed) place_.expectAny();
    if (!believe(input)) {
        faults |= kFaultBadDevicePose;
        return;  // the last good one stays
    }
    if (is_first) {
        X_VT_ = X_VT_device_;  // the simulated tool starts where the hand is
    } else if (is_placed) {
        placeTool();
    } else if (place_.hasJumped()) {
        noteSuddenChange(SuddenChange::kHandJumps);
    }
}

// The hand was put where it is without a way there, and the simulated tool goes along: by its own way it
// might be caught behind bone. In bone it has no place; then it begins beside it, on the side that its shaft
// comes from.
void HapticTick::placeTool() noexcept {
    constexpr int kMaxSteps = 64;  // of a burr's radius: some cm
    Pose X_VT = X_VT_device_;
    const double radius = tools_[tool_].burr.radius;
    const Eigen::Vector3d step = radius * (X_VT.rotation * Eigen::Vector3d::UnitY());
    int steps = 0;
    for (; steps < kMaxSteps && isInBone(X_VT, radius); ++steps) X_VT.position += step;
    noteSuddenChange(SuddenChange::kHandJumps);
    if (steps == kMaxSteps) return;  // it comes as it can
    X_VT_ = X_VT;
    unmilled_periods_ = 0;
    model_->restart();
    models_.forEach([](SpoModel& model) { model.expectOtherBone(); });
    effects_.restart(Restart::kOtherLaw);
}

// Looks at the burr's middle and at six places at this distance from it.
bool HapticTick::isInBone(const Pose& X_VT, double radius) const noexcept {
    for (int i = -1; i < 6; ++i) {
        const Eigen::Vector3d offset =
            i < 0 ? Eigen::Vector3d::Zero().eval()
                  : ((i % 2 ? -radius : radius) * Eigen::Vector3d::Unit(i / 2)).eval();
        if (bone_.volume.isBoneAt(X_VT.position + offset)) return true;
    }
    return false;
}

bool HapticTick::believe(const DeviceInput& input) noexcept {
    Pose X_WT_sample = input.X_WT_device;
    const double norm = X_WT_sample.rotation.norm();
    if (!X_WT_sample.isFinite() || !(std::abs(norm - 1) < kQuaternionNormSlack)) {
        place_.refuse(input.periods);
        return false;
    }
    X_WT_sample.rotation.coeffs() /= norm;
    const Pose X_VT_reading = X_VW_ * X_WT_sample;
    const bool is_believed = input.is_repeated ? place_.repeat(input.periods)  //
                                               : place_.take(X_VT_reading, input.periods);
    if (!is_believed) return false;
    X_VT_device_ = model_->traits().wants_estimate
                       ? estimate_.take(X_VT_reading, hand_coupling_.standsAlone())
                       : X_VT_reading;
    return true;
}

void HapticTick::beginEffects(const DeviceInput& input) noexcept {
    if (effects_.isEmpty()) return;
    const bool remove = input.buttons & kButtonRemove;
    const bool add = input.buttons & kButtonAdd;
    if (!input.is_stale && !remove && !add) waits_for_release_ = false;
    EffectStart start;
    start.dt = config_.dt * input.periods;
    start.periods = input.periods;
    start.may_mill = !place_.isLost() && !input.is_stale && input.device.isEngaged() && !waits_for_release_ &&
                     !decisions_.is_milling_paused;
    start.is_pedal_down = start.may_mill && remove && !add;
    start.is_add_wanted = start.may_mill && add && !remove;
    if (start.is_pedal_down != was_pedal_down_ || start.is_add_wanted != was_add_wanted_) {
        noteSuddenChange(SuddenChange::kPedal);
        unmilled_periods_ = 0;  // what the pedal said then was another thing
    }
    may_mill_ = start.may_mill;
    was_pedal_down_ = start.is_pedal_down, was_add_wanted_ = start.is_add_wanted;
    start.tool = &tools_[tool_];
    start.shape =
        model_->traits().mills_voxel_centres ? MillingShape::kVoxelCentres : MillingShape::kSubVoxel;
    start.X_VT_start = X_VT_;
    if (unmilled_periods_ == 0) X_VT_milled_ = X_VT_;
    start.X_VT_milled = X_VT_milled_;
    start.milled_periods = input.periods + unmilled_periods_;
    start.milling_thrift = decisions_.milling_thrift;
    start.milled_dt = config_.dt * start.milled_periods;
    model_->setCutting(start.is_pedal_down);
    effects_.begin(start);
}

SpoStep HapticTick::moveAndFeel(const DeviceInput& input, uint32_t& faults) noexcept {
    SpoStep step = model_->advance(X_VT_, hand_coupling_.pulledFrom(X_VT_device_));
    X_VT_ = step.X_VT;
    if (!step.is_solved) faults |= kFaultSolve;
    if (step.is_motion_clamped) faults |= kFaultMotionClamped;
    if (step.has_stalled) faults |= kFaultStalled;
    if (step.has_fewer_samples) faults |= kFaultFewerSamples;
    if (step.has_contact_overflow) faults |= kFaultContactOverflow;
    if (step.is_tool_growing) noteSuddenChange(SuddenChange::kToolGrows);
    keepAccount(step, input);
    effects_.addToHand(step.wrench_hand_V);
    step.wrench_hand_V.torque = config_.hand_space.torqueAtHand(step.wrench_hand_V.torque);
    const bool is_felt = step.is_solved && !place_.isLost();
    step.wrench_hand_V = hand_limits_.limit(
        {step.wrench_hand_V, is_felt, X_VT_device_, input.stale_factor, was_bone_taken_, place_.hasJumped()});
    if (hand_limits_.wasLimited()) faults |= kFaultForceClamped;
    return step;
}

TickRecord HapticTick::makeRecord(const DeviceInput& input, const SpoStep& step) const noexcept {
    TickRecord record{};
    record.tick = tick_;
    record.start_ns = input.start_ns;
    record.wakeup_latency_ns = input.wakeup_latency_ns;
    record.t_s = input.t_s;
    const Pose X_WT = X_WV_ * X_VT_, X_WT_device = X_WV_ * X_VT_device_;
    const Wrench wrench_hand_W = step.wrench_hand_V.rotatedBy(X_WV_.rotation);
    copyTo(record.p_WT, X_WT.position);
    copyTo(record.q_WT, wxyz(X_WT.rotation));
    copyTo(record.p_WT_device, X_WT_device.position);
    copyTo(record.q_WT_device, wxyz(X_WT_device.rotation));
    copyTo(record.f_hand_W, wrench_hand_W.force);
    copyTo(record.t_hand_W, wrench_hand_W.torque);
    record.contacts = step.contacts;
    record.candidates = step.candidates;
    record.iterations = step.iterations;
    record.max_penetration = step.max_penetration;
    record.coupling_share = hand_coupling_.share();
    record.rotation_share = hand_coupling_.rotationShare();
    record.buttons = input.buttons;
    record.tool = uint32_t(tool_);
    record.waits_for_release = waits_for_release_;
    record.device = input.device;
    record.bone_order = history_ ? history_->finishedOrder() : 0;
    return record;
}

}  // namespace bonemill

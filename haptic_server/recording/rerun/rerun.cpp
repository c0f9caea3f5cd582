#include "haptic_server/recording/rerun/rerun.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "common/base/assert.h"
#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "common/text/foreign_text.h"
#include "haptic_server/core/tick/tick_once.h"
#include "haptic_server/recording/journal/build_facts.h"
#include "haptic_server/scene/setup/scene_accuracy.h"

namespace bonemill {
namespace {

// The last one that is not behind the tick.
const Keyframe& keyframeBefore(const std::vector<Keyframe>& keyframes, uint64_t tick) {
    const auto after = std::ranges::upper_bound(keyframes, tick, {}, &Keyframe::tick);
    return after == keyframes.begin() ? keyframes.front() : *std::prev(after);
}

void requireSameScene(const Recording& recording, const LoadedScene& scene) {
    if (recording.manifest().scene_hash() == sceneHashOf(scene.scene)) return;
    throw UserError(recording.path().string() + ": is a session of the scene '" +
                    printableLine(recording.manifest().scene_name()) + "' as it was then, which " +
                    scene.file.string() + " is not");
}

// Whoever goes on mills this PC's files, wherever they lay then: by name and hash they are the session's.
void requireSameVolume(const Recording& recording, const LoadedScene& scene) {
    for (const NamedFile& read : filesOf(scene)) {
        if (read.path == scene.file) continue;
        const std::string hash = sha256Of(read.path);
        const auto is_same = [&](const journal::File& file) {
            return file.what() == read.name && file.sha256() == hash;
        };
        if (std::ranges::none_of(recording.manifest().files(), is_same))
            throw UserError(recording.path().string() + ": " + read.name + " " + read.path.string() +
                            " is not the one that the session milled");
    }
}

std::string secondsText(double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f s", seconds);
    return text;
}

// References to the tick stay in it.
DeviceInput inputOf(const JournalTick& tick, const DeviceCapabilities* device) {
    const TickInput& in = tick.input;
    DeviceInput input;
    input.X_WT_device = {Eigen::Vector3d(in.p_WT),
                         Eigen::Quaterniond(in.q_WT[0], in.q_WT[1], in.q_WT[2], in.q_WT[3])};
    input.is_repeated = in.is_repeated;
    input.buttons = tick.buttons;
    input.placements = in.placements;
    input.device = tick.device;
    input.other_device = device;
    input.faults = in.faults;
    input.stale_factor = in.stale_factor;
    input.is_stale = in.is_stale;
    input.periods = in.periods;
    input.t_s = secondsOfNs(tick.start_ns);
    input.decisions = &in.decisions;
    return input;
}

}  // namespace

MomentName momentNameOf(const std::string& text) {
    const size_t at = text.rfind('@');
    MomentName name;
    bool is_number = false;
    if (at != std::string::npos) {
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data() + at + 1, end, name.seconds);
        is_number = error == std::errc() && stop == end && std::isfinite(name.seconds) && name.seconds >= 0;
    }
    if (!is_number || at == 0)
        throw UserError("--from " + text + ": expected FILE.mcap@SECONDS, such as session.mcap@95");
    name.journal = text.substr(0, at);
    return name;
}

BoneModel scannedCopyOf(const SceneSetup& simulation, const LoadedScene& scene) {
    const BoneModel& bone = *simulation.bone;
    return {bone.volume.withoutSpareBricks(), bone.lattice.leafCells(), shellConfigOf(scene.scene)};
}

RecordedMoment momentOf(const Recording& recording, const SceneSetup& simulation, const LoadedScene& scene,
                        double seconds) {
    requireSameScene(recording, scene);
    requireSameVolume(recording, scene);
    if (seconds > recording.lengthS())
        throw UserError(recording.path().string() + ": ends after " + secondsText(recording.lengthS()) +
                        ", before " + secondsText(seconds));
    const uint64_t tick = recording.tickAt(seconds);
    BoneModel bone = scannedCopyOf(simulation, scene);
    const Recording::Bones bones = recording.readBones(bone);
    if (!bones.problem.empty()) throw UserError(recording.path().string() + ": " + bones.problem);
    Rerun rerun(recording, simulation, bones.checkpoints, bone, bones.keyframes.front());
    if (const Keyframe& from = keyframeBefore(bones.keyframes, tick); from.tick > 0) rerun.startAt(from);
    TickDecisions decisions;
    while (rerun.next() <= tick) decisions = rerun.step().input.decisions;
    scene::Tuning tuning;
    const uint32_t recorded = RecordedTicks(recording).at(tick).input.decisions.tuning;
    if (const auto known = recording.content().tunings.find(recorded);
        known != recording.content().tunings.end())
        tuning = known->second;
    RecordedMoment moment;
    moment.bone = rerun.history().snapshot(bone);
    moment.tool = decisions.tool;
    moment.accuracy = decisions.accuracy;
    moment.tuning = tuning;
    moment.from.set_file(recording.path().filename().string());
    moment.from.set_journal_id(recording.manifest().journal_id());
    moment.from.set_tick(tick + 1);
    moment.from.set_segment(recording.manifest().resumed_from().segment() + 1);
    return moment;
}

Rerun::Rerun(const Recording& recording, const SceneSetup& simulation, const RecordedCheckpoints& checkpoints,
             BoneModel& bone, const Keyframe& start)
    : recording_(recording),
      checkpoints_(checkpoints),
      config_(simulation.tick),
      bone_(bone),
      history_(bone),
      tools_(simulation.spoTools()),
      accuracy_(simulation.accuracy),
      tunings_(simulation.tunable.with({})),
      ticks_(recording) {
    addTunings(simulation.tunable);
    if (start.bone) history_.startFrom(bone_, start.bone);
    next_ = start.tick;
    makeTick();
}

// A journal may be anybody's: what could not have been tuned so counts as the scene's own.
void Rerun::addTunings(const TunableScene& scene) {
    for (const auto& [number, values] : recording_.content().tunings)
        if (scene.problem(values).empty()) tuning_numbers_[number] = tunings_.add(scene.with(values));
}

uint32_t Rerun::tuningOf(const TickDecisions& decisions) const {
    const auto known = tuning_numbers_.find(decisions.tuning);
    return known == tuning_numbers_.end() ? TuningSwitch::kOfScene : known->second;
}

void Rerun::startAt(const Keyframe& keyframe) {
    tick_.reset();
    history_.restore(keyframe.bone);
    history_.restoreAll(bone_);
    next_ = keyframe.tick;
    makeTick();
}

void Rerun::makeTick() {
    const TickDecisions first = ticks_.at(std::min(next_, recording_.ticks() - 1)).input.decisions;
    choose(first);
    bone_order_ = next_ == 0 ? 0 : ticks_.at(next_ - 1).input.decisions.bone_order;
    if (next_ == 0 && !recording_.content().put_backs.contains(first.bone_order))
        bone_order_ = first.bone_order;
    done_order_ = bone_order_;
    is_device_told_ = false;
    has_left_ = false;
    tick_ = std::make_unique<HapticTick>(config_, TickBone{bone_, &history_},
                                         TickChoices{tools_, accuracy_, &tunings_});
}

// What the journal names was checked against the scene's tools and the presets when it was read.
void Rerun::choose(const TickDecisions& decisions) {
    tools_.choose(std::min<size_t>(decisions.tool, tools_.count() - 1));
    accuracy_.choose(std::min<size_t>(decisions.accuracy, AccuracySwitch::count() - 1));
}

// The order was there when the tick took it up.
void Rerun::putBack(const TickDecisions& decisions) {
    if (decisions.bone_order == bone_order_) return;
    bone_order_ = decisions.bone_order;
    // Both are there: Recording::readBones() has seen to it.
    const auto order = recording_.content().put_backs.find(bone_order_);
    if (order == recording_.content().put_backs.end()) return;
    const auto checkpoint = checkpoints_.find(order->second);
    // As after an order that no tick took up: the same target, asked for once more, is a new order.
    history_.restore(std::make_shared<const BoneSnapshot>());
    history_.restore(checkpoint == checkpoints_.end() ? nullptr : checkpoint->second);
}

const TickRecord& Rerun::step() {
    BONEMILL_ASSERT(!has_left_);
    run(ticks_.at(next_));
    ++next_;
    return record_;
}

const TickRecord& Rerun::stepOtherwise(const JournalTick& tick) {
    run(tick);
    has_left_ = true;
    return record_;
}

void Rerun::run(JournalTick tick) {
    choose(tick.input.decisions);
    tick.input.decisions.tool = uint32_t(tools_.chosen());
    tick.input.decisions.accuracy = uint32_t(accuracy_.choice());
    tick.input.decisions.tuning = tuningOf(tick.input.decisions);
    putBack(tick.input.decisions);
    const DeviceCapabilities* device = tick.input.has_other_device ? &tick.input.other_device : nullptr;
    if (!is_device_told_ && !device) device = recording_.deviceBefore(next_);
    is_device_told_ = true;
    run(inputOf(tick, device));
    tunings_.choose(tick.input.decisions.tuning);
}

void Rerun::run(const DeviceInput& input) {
    is_put_back_ = history_.isRestoring();
    record_ = tickOnce(*tick_, input);
    if (!history_.isRestoring()) done_order_ = bone_order_;
    record_.bone_order = done_order_;
}

const TickRecord& Rerun::step(const Pose& X_WT_hand, uint32_t buttons) {
    DeviceInput input;
    input.X_WT_device = X_WT_hand;
    input.buttons = buttons;
    input.placements = record_.input.placements;
    input.t_s = next_ == 0 && !has_left_ ? 0 : record_.t_s + config_.dt;
    if (!is_device_told_) input.other_device = recording_.deviceBefore(next_);
    is_device_told_ = true;
    run(input);
    has_left_ = true;
    return record_;
}

}  // namespace bonemill

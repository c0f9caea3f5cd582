// Clients may ask this of a session, and the session says this of itself in return. All members belong to
// the publisher thread.
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "common/base/units.h"
#include "common/commands/answer.h"
#include "common/commands/role_rules.h"
#include "common/config/scene_check.h"
#include "common/rt/clock.h"
#include "common/text/foreign_text.h"
#include "haptic_server/core/bone/checkpoints.h"
#include "haptic_server/core/tick/tick_choices.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/server/session/attempt_controller.h"
#include "haptic_server/server/session/journal_recorder.h"
#include "haptic_server/server/session/recorder.h"
#include "haptic_server/server/session/session_export.h"
#include "haptic_server/teaching/lessons/lesson_state.h"
#include "haptic_server/teaching/lessons/remark_list.h"
#include "proto/topics.pb.h"

namespace bonemill {

// Who shows a recorded session answers these instead of a live one (replay/player.h). The publisher thread
// calls all members; none waits.
class ReplayOrders {
  public:
    virtual ~ReplayOrders() = default;
    // Lets the recording go on, or holds it.
    virtual void play(bool goes_on) = 0;
    virtual Answer carryOut(const topics::ReplayOrder& order) = 0;
    // Fills in how the replay stands.
    virtual void describe(topics::Replay& replay) const = 0;
};

// The commands act on this; the tick takes each up by itself.
struct SessionControls {
    BoneHistory& history;
    AccuracySwitch& accuracy;
    ToolSwitch& tools;
    std::atomic<bool>& stop_requested;
    SessionExport& bone_export;
    std::atomic<uint32_t>& reset_orders;  // counts the orders to reset the device
    LessonState& lesson;
    AttemptController& attempts;
    OrderLimits& limits;
    JournalRecorder& journal;
    ReplayOrders* replay = nullptr;  // there where a recording is shown
};

class SessionCommands {
  public:
    // References must outlive this object. With `only_instructors` all others may only look.
    SessionCommands(const scene::Scene& scene, const BoneModel& bone, const Recorder& recorder,
                    const SessionControls& controls, bool only_instructors)
        : controls_(controls),
          recorder_(recorder),
          checkpoints_(controls.history, bone),
          remarks_(bone.volume.geometry()),
          voxel_mm3_(bone.volume.voxelVolume() * kPerCubicMillimetre),
          is_switchable_(scene.accuracy().switchable()),
          effect_of_gradient_law_(effectOfGradientLaw(scene.effects())),
          open_to_(openTo(scene, only_instructors)) {}

    // Nothing means that the command has begun, and its end comes with takeResult().
    std::optional<Answer> carryOut(const topics::Command& command) {
        if (const std::string why_not = whyNot(command); !why_not.empty()) return Answer::refused(why_not);
        if (controls_.replay) return carryOutInReplay(command);
        switch (command.action_case()) {
            case topics::Command::kReplay:
                return Answer::refused("this is a live session, not a replay (docs/teach/replay.md)");
            case topics::Command::kResetVolume:
                return restore(Checkpoints::kScannedBone);
            case topics::Command::kPauseMilling:
                controls_.history.pauseMilling(command.pause_milling());
                return Answer::done();
            case topics::Command::kSetAccuracy:
                return setAccuracy(command.set_accuracy());
            case topics::Command::kSelectTool:
                return selectTool(command.select_tool());
            case topics::Command::kSaveCheckpoint:
                checkpoints_.save(sessionS());
                controls_.journal.noteCheckpoint(checkpoints_.kept().back());
                return Answer::done();
            case topics::Command::kRestoreCheckpoint:
                return restore(command.restore_checkpoint());
            case topics::Command::kShutDown:
                controls_.stop_requested = true;
                return Answer::done();
            case topics::Command::kExport:
                return controls_.bone_export.begin(command.export_());
            case topics::Command::kResetDevice:
                controls_.reset_orders.fetch_add(1, std::memory_order_relaxed);
                return Answer::done();
            case topics::Command::kChooseScene:
                return controls_.lesson.orderScene(command);
            case topics::Command::kStartAttempt:
                return controls_.attempts.start(command);
            case topics::Command::kStopAttempt:
                return controls_.attempts.stop(command);
            case topics::Command::kAddRemark:
                return remarks_.add(command, sessionS());
            case topics::Command::kEraseRemark:
                return remarks_.erase(command.erase_remark());
            default:
                return Answer::refused("this server does not know the action");
        }
    }
    // This is how the command that was begun has ended, once it has.
    std::optional<Answer> takeResult() { return controls_.bone_export.takeResult(); }
    void waitForResult() { controls_.bone_export.wait(); }
    LessonState& lesson() noexcept { return controls_.lesson; }
    JournalRecorder& journal() noexcept { return controls_.journal; }
    Checkpoints& checkpoints() noexcept { return checkpoints_; }
    AttemptController& attempts() noexcept { return controls_.attempts; }
    RemarkList& remarks() noexcept { return remarks_; }
    // Fills in the session clock, the pause, the checkpoints and what the bone has lost.
    void describe(topics::Status& status) const {
        status.set_session_s(sessionS());
        if (controls_.replay) {
            const auto latest = recorder_.latest();
            status.set_is_milling_paused(latest && latest->input.decisions.is_milling_paused);
            status.set_bone_restores(controls_.history.finishedOrder());
            controls_.replay->describe(*status.mutable_replay());
        } else {
            status.set_is_milling_paused(controls_.history.isMillingPaused());
            status.set_bone_restores(controls_.history.newestOrder());
        }
        status.set_removed_mm3(double(controls_.history.missingVoxels()) * voxel_mm3_);
        for (const Checkpoints::Checkpoint& kept : checkpoints_.kept()) {
            topics::Checkpoint* checkpoint = status.add_checkpoints();
            checkpoint->set_id(kept.id);
            checkpoint->set_session_s(kept.session_s);
            checkpoint->set_removed_mm3(double(kept.snapshot->missing_voxels) * voxel_mm3_);
        }
    }
    const ToolSwitch& tools() const noexcept { return controls_.tools; }
    const AccuracySwitch& accuracy() const noexcept { return controls_.accuracy; }

  private:
    static OpenTo openTo(const scene::Scene& scene, bool only_instructors) {
        if (scene.assessment().exam()) return OpenTo::kInstructorsInExam;
        return only_instructors ? OpenTo::kInstructors : OpenTo::kAllRoles;
    }

    // Empty if it may be carried out.
    std::string whyNot(const topics::Command& command) const {
        const CommandAction action = command.action_case();
        if (std::string why_not = whyNotOrder(command.role(), action, open_to_); !why_not.empty())
            return why_not;
        if (rowOf(action).is_plain() && !command.GetReflection()->GetBool(command, fieldOf(action)))
            return "a command that is false asks for nothing; send true";
        return controls_.limits.whyNotNow(action, monotonicNowNs());
    }
    // What a recording holds stays as it was.
    std::optional<Answer> carryOutInReplay(const topics::Command& command) {
        switch (command.action_case()) {
            case topics::Command::kReplay:
                return controls_.replay->carryOut(command.replay());
            case topics::Command::kPauseMilling:
                controls_.replay->play(!command.pause_milling());
                return Answer::done();
            case topics::Command::kAddRemark:
                return remarks_.add(command, sessionS());
            case topics::Command::kEraseRemark:
                return remarks_.erase(command.erase_remark());
            case topics::Command::kShutDown:
                controls_.stop_requested = true;
                return Answer::done();
            default:
                return Answer::refused(
                    "this is a replay of a recorded session: it is led, not commanded "
                    "(docs/teach/replay.md)");
        }
    }
    Answer setAccuracy(const std::string& name) {
        const auto preset = presetOfName(name);
        if (name != "scene" && !preset)
            return Answer::refused("no preset is called '" + repeatedText(name) + "'; " + presetNames() +
                                   " or scene");
        if (!is_switchable_ && preset) return Answer::refused("the scene says accuracy.switchable: false");
        if (preset && presetSettings(*preset).law != ContactLaw::kGradient && effect_of_gradient_law_)
            return Answer::refused(std::string("effects.") + effect_of_gradient_law_ +
                                   " of the scene needs the gradient contact law, which " + name + " is not");
        controls_.accuracy.choose(preset ? AccuracySwitch::choiceOf(*preset) : AccuracySwitch::kSceneChoice);
        return Answer::done();
    }
    Answer selectTool(uint32_t index) {
        if (index >= controls_.tools.count())
            return Answer::refused("there is no tool " + std::to_string(index + uint64_t{1}) +
                                   "; the scene has " + std::to_string(controls_.tools.count()));
        controls_.tools.choose(index);
        return Answer::done();
    }
    Answer restore(uint32_t checkpoint) {
        if (checkpoints_.has(checkpoint)) {
            controls_.journal.expectPutBack(checkpoint);
            checkpoints_.restore(checkpoint);
            controls_.attempts.noteRestored();
            return Answer::done();
        }
        return Answer::refused("there is no checkpoint " + std::to_string(checkpoint) +
                               (checkpoints_.kept().empty()
                                    ? "; none is saved"
                                    : "; the oldest is " + std::to_string(checkpoints_.kept().front().id) +
                                          ", the newest " + std::to_string(checkpoints_.kept().back().id)));
    }
    double sessionS() const {
        const auto latest = recorder_.latest();
        return latest ? latest->t_s : 0;
    }

    SessionControls controls_;
    const Recorder& recorder_;
    Checkpoints checkpoints_;
    RemarkList remarks_;
    double voxel_mm3_;
    bool is_switchable_;
    const char* effect_of_gradient_law_;  // null: none
    OpenTo open_to_;
};

}  // namespace bonemill

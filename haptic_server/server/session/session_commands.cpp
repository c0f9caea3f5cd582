#include "haptic_server/server/session/session_commands.h"

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "common/text/foreign_text.h"

namespace bonemill {
namespace {

OpenTo openTo(const scene::Scene& scene, bool only_instructors) {
    if (scene.assessment().exam()) return OpenTo::kInstructorsInExam;
    return only_instructors ? OpenTo::kInstructors : OpenTo::kAllRoles;
}

}  // namespace

SessionCommands::SessionCommands(const scene::Scene& scene, const BoneModel& bone, const Recorder& recorder,
                                 const SessionControls& controls, bool only_instructors)
    : controls_(controls),
      recorder_(recorder),
      checkpoints_(controls.history, bone),
      remarks_(bone.volume.geometry()),
      voxel_mm3_(bone.volume.voxelVolume() * kPerCubicMillimetre),
      presets_(scene),
      open_to_(openTo(scene, only_instructors)) {}

std::optional<Answer> SessionCommands::carryOut(const topics::Command& command) {
    if (const std::string why_not = whyNot(command); !why_not.empty()) return Answer::refused(why_not);
    if (controls_.replay) return carryOutInReplay(command);
    switch (command.action_case()) {
        case topics::Command::kReplay:
            return Answer::refused("this is a live session, not a replay (docs/howto/replay.md)");
        case topics::Command::kResetVolume:
            return restore(Checkpoints::kScannedBone);
        case topics::Command::kPauseMilling:
            controls_.history.pauseMilling(command.pause_milling());
            return Answer::done();
        case topics::Command::kSetAccuracy:
            return setAccuracy(command.set_accuracy());
        case topics::Command::kTune:
            return controls_.tuning ? controls_.tuning->tune(command.tune())
                                    : Answer::refused("nothing can be tuned here");
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
        case topics::Command::kBeginAgain:
            return beginAgain();
        case topics::Command::kTakeOver:
            return controls_.hand.takeOver(command.sender());
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

// What a recording holds stays as it was.
std::optional<Answer> SessionCommands::carryOutInReplay(const topics::Command& command) {
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
                "(docs/howto/replay.md)");
    }
}

std::string SessionCommands::whyNot(const topics::Command& command) const {
    const CommandAction action = command.action_case();
    if (std::string why_not = whyNotOrder(command.role(), action, open_to_); !why_not.empty()) return why_not;
    if (rowOf(action).is_plain() && !command.GetReflection()->GetBool(command, fieldOf(action)))
        return "a command that is false asks for nothing; send true";
    return controls_.limits.whyNotNow(action, monotonicNowNs());
}

Answer SessionCommands::setAccuracy(const std::string& name) {
    const auto preset = presetOfName(name);
    if (name != "scene" && !preset)
        return Answer::refused("no preset is called '" + repeatedText(name) + "'; " + presetNames() +
                               " or scene");
    if (const std::string why_not = preset ? presets_.whyNot(*preset) : ""; !why_not.empty())
        return Answer::refused(why_not);
    controls_.accuracy.choose(preset ? AccuracySwitch::choiceOf(*preset) : AccuracySwitch::kSceneChoice);
    return Answer::done();
}

Answer SessionCommands::selectTool(uint32_t index) {
    if (index >= controls_.tools.count())
        return Answer::refused("there is no tool " + std::to_string(index + uint64_t{1}) +
                               "; the scene has " + std::to_string(controls_.tools.count()));
    controls_.tools.choose(index);
    return Answer::done();
}

// An attempt has a bone and a beginning of its own.
Answer SessionCommands::beginAgain() {
    if (controls_.attempts.isRunning())
        return Answer::refused("an attempt is under way: end it, or start the next one");
    if (const std::string why_not = controls_.hand.whyNotAgain(); !why_not.empty())
        return Answer::refused(why_not);
    const Answer answer = restore(Checkpoints::kScannedBone);
    controls_.history.pauseMilling(false);
    controls_.hand.beginAnew();
    return answer;
}

Answer SessionCommands::restore(uint32_t checkpoint) {
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

double SessionCommands::sessionS() const {
    const auto latest = recorder_.latest();
    return latest ? latest->t_s : 0;
}

void SessionCommands::describe(topics::Status& status) const {
    status.set_session_s(sessionS());
    if (controls_.tuning) controls_.tuning->describe(status);
    if (controls_.replay) {
        const auto latest = recorder_.latest();
        status.set_is_milling_paused(latest && latest->input.decisions.is_milling_paused);
        status.set_bone_restores(controls_.history.finishedOrder());
        controls_.replay->describe(*status.mutable_replay());
    } else {
        if (status.has_device()) controls_.hand.describe(*status.mutable_device());
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

}  // namespace bonemill

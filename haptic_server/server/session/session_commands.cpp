#include "haptic_server/server/session/session_commands.h"

#include "common/base/units.h"
#include "common/commands/role_rules.h"
#include "common/config/effect_check.h"
#include "common/rt/clock.h"
#include "common/text/repeated_text.h"

namespace bonemill {
namespace {

// Some actions are a bool only because an action must have a value: false says nothing that could be done.
bool asksForNothing(const topics::Command& command) {
    switch (command.action_case()) {
        case topics::Command::kResetVolume:
            return !command.reset_volume();
        case topics::Command::kSaveCheckpoint:
            return !command.save_checkpoint();
        case topics::Command::kShutDown:
            return !command.shut_down();
        case topics::Command::kResetDevice:
            return !command.reset_device();
        case topics::Command::kStopAttempt:
            return !command.stop_attempt();
        default:
            return false;
    }
}

}  // namespace

SessionCommands::SessionCommands(const scene::Scene& scene, const BoneModel& bone, const Recorder& recorder,
                                 const SessionControls& controls, bool only_instructors)
    : controls_(controls),
      recorder_(recorder),
      checkpoints_(controls.history, bone),
      remarks_(bone.volume.geometry()),
      voxel_mm3_(bone.volume.voxelVolume() * kPerCubicMillimetre),
      is_switchable_(scene.accuracy().switchable()),
      effect_of_gradient_law_(effectOfGradientLaw(scene.effects())),
      only_instructors_(only_instructors),
      is_exam_(scene.assessment().exam()) {}

std::optional<std::string> SessionCommands::carryOut(const topics::Command& command) {
    if (const std::string refusal = refusalOf(command); !refusal.empty()) return refusal;
    if (asksForNothing(command)) return "refused: a command that is false asks for nothing; send true";
    if (std::string refusal = controls_.limits.refusalOf(command, monotonicNowNs()); !refusal.empty())
        return refusal;
    if (controls_.replay) return carryOutInReplay(command);
    switch (command.action_case()) {
        case topics::Command::kReplay:
            return "refused: this is a live session, not a replay (docs/teach/replay.md)";
        case topics::Command::kResetVolume:
            return restore(Checkpoints::kScannedBone);
        case topics::Command::kPauseMilling:
            controls_.history.pauseMilling(command.pause_milling());
            return "done";
        case topics::Command::kSetAccuracy:
            return setAccuracy(command.set_accuracy());
        case topics::Command::kSelectTool:
            return selectTool(command.select_tool());
        case topics::Command::kSaveCheckpoint:
            checkpoints_.save(sessionS());
            controls_.journal.noteCheckpoint(checkpoints_.kept().back());
            return "done";
        case topics::Command::kRestoreCheckpoint:
            return restore(command.restore_checkpoint());
        case topics::Command::kShutDown:
            controls_.stop_requested = true;
            return "done";
        case topics::Command::kExport:
            return controls_.bone_export.begin(command.export_());
        case topics::Command::kResetDevice:
            controls_.reset_orders.fetch_add(1, std::memory_order_relaxed);
            return "done";
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
            return "refused: this server does not know the action";
    }
}

// What a recording holds stays as it was.
std::optional<std::string> SessionCommands::carryOutInReplay(const topics::Command& command) {
    switch (command.action_case()) {
        case topics::Command::kReplay:
            return controls_.replay->carryOut(command.replay());
        case topics::Command::kPauseMilling:
            controls_.replay->play(!command.pause_milling());
            return "done";
        case topics::Command::kAddRemark:
            return remarks_.add(command, sessionS());
        case topics::Command::kEraseRemark:
            return remarks_.erase(command.erase_remark());
        case topics::Command::kShutDown:
            controls_.stop_requested = true;
            return "done";
        default:
            return "refused: this is a replay of a recorded session: it is led, not commanded "
                   "(docs/teach/replay.md)";
    }
}

// The refusal is empty if the role allows the command.
std::string SessionCommands::refusalOf(const topics::Command& command) const {
    if (is_exam_ && command.role() != topics::Viewer::INSTRUCTOR)
        return "refused: this scene is an examination; only instructors command it";
    if (only_instructors_ && command.role() != topics::Viewer::INSTRUCTOR)
        return "refused: only instructors command this session (--instructor-only)";
    return std::string(refusalOfRole(command.role(), command.action_case()));
}

std::string SessionCommands::setAccuracy(const std::string& name) {
    const auto preset = presetOfName(name);
    if (name != "scene" && !preset)
        return "refused: no preset is called '" + repeatedText(name) + "'; " + presetNames() + " or scene";
    if (!is_switchable_ && preset) return "refused: the scene says accuracy.switchable: false";
    if (preset && presetSettings(*preset).law != ContactLaw::kGradient && effect_of_gradient_law_)
        return std::string("refused: effects.") + effect_of_gradient_law_ +
               " of the scene needs the gradient contact law, which " + name + " is not";
    controls_.accuracy.choose(preset ? AccuracySwitch::choiceOf(*preset) : AccuracySwitch::kSceneChoice);
    return "done";
}

std::string SessionCommands::selectTool(uint32_t index) {
    if (index >= controls_.tools.count())
        return "refused: there is no tool " + std::to_string(index + uint64_t{1}) + "; the scene has " +
               std::to_string(controls_.tools.count());
    controls_.tools.choose(index);
    return "done";
}

std::string SessionCommands::restore(uint32_t checkpoint) {
    if (checkpoints_.has(checkpoint)) {
        controls_.journal.expectPutBack(checkpoint);
        checkpoints_.restore(checkpoint);
        controls_.attempts.noteRestored();
        return "done";
    }
    return "refused: there is no checkpoint " + std::to_string(checkpoint) +
           (checkpoints_.kept().empty()
                ? "; none is saved"
                : "; the oldest is " + std::to_string(checkpoints_.kept().front().id) + ", the newest " +
                      std::to_string(checkpoints_.kept().back().id));
}

double SessionCommands::sessionS() const {
    const auto latest = recorder_.latest();
    return latest ? latest->t_s : 0;
}

void SessionCommands::describe(topics::Status& status) const {
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

}  // namespace bonemill

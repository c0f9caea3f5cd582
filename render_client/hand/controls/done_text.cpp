#include "render_client/hand/controls/done_text.h"

namespace bonemill {

std::string doneText(const topics::Command& command, const topics::Lesson* lesson) {
    switch (command.action_case()) {
        case topics::Command::kResetVolume:
            return "The bone is whole again";
        case topics::Command::kShutDown:
            return "The session ends";
        case topics::Command::kPauseMilling:
            return command.pause_milling() ? "Milling pauses" : "Milling goes on";
        case topics::Command::kSetAccuracy:
            return "Accuracy is " + command.set_accuracy() + " now";
        case topics::Command::kSelectTool:
            return "Tool " + std::to_string(command.select_tool() + 1) + " is in the hand";
        case topics::Command::kSaveCheckpoint:
            return "A checkpoint is saved";
        case topics::Command::kRestoreCheckpoint:
            return command.restore_checkpoint() == 0 ? "The bone is whole again"
                                                     : "The bone is as it was at checkpoint " +
                                                           std::to_string(command.restore_checkpoint());
        case topics::Command::kResetDevice:
            return "The device is reset";
        case topics::Command::kChooseScene:
            return "The exercise changes";
        case topics::Command::kStartAttempt:
            return command.start_attempt() + "'s attempt has begun";
        case topics::Command::kStopAttempt:
            return (lesson && !lesson->trainee().empty() ? lesson->trainee() + "'s" : "The") +
                   std::string(" attempt has ended");
        case topics::Command::kAddRemark:
            return command.add_remark().note().empty() ? "Everyone sees the stroke"
                                                       : "Everyone sees the note";
        case topics::Command::kEraseRemark:
            return command.erase_remark() == 0 ? "All notes and strokes are erased" : "It is erased";
        default:
            return "It is done";
    }
}

}  // namespace bonemill

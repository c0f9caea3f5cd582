#include "render_client/link/subscribe/command_text.h"

#include <cstdio>

namespace bonemill {
namespace {

std::string replayText(const topics::ReplayOrder& order) {
    char text[64] = "no order to the replay";
    switch (order.order_case()) {
        case topics::ReplayOrder::kSeekS:
            std::snprintf(text, sizeof text, "go to %.2f s", order.seek_s());
            break;
        case topics::ReplayOrder::kSpeed:
            std::snprintf(text, sizeof text, "speed %g", order.speed());
            break;
        case topics::ReplayOrder::kJump:
            return order.jump() < 0 ? "event before" : "next event";
        case topics::ReplayOrder::kRemovalAt:
            return "when this was removed";
        case topics::ReplayOrder::ORDER_NOT_SET:
            break;
    }
    return text;
}

}  // namespace

std::string commandText(const topics::Command& command) {
    switch (command.action_case()) {
        case topics::Command::kResetVolume:
            return "put the bone back";
        case topics::Command::kShutDown:
            return "shut down";
        case topics::Command::kPauseMilling:
            return command.pause_milling() ? "pause milling" : "go on milling";
        case topics::Command::kSetAccuracy:
            return "accuracy " + command.set_accuracy();
        case topics::Command::kSelectTool:
            return "tool " + std::to_string(command.select_tool() + 1);
        case topics::Command::kSaveCheckpoint:
            return "save a checkpoint";
        case topics::Command::kRestoreCheckpoint:
            return command.restore_checkpoint() == 0
                       ? "put the bone back"
                       : "back to checkpoint " + std::to_string(command.restore_checkpoint());
        case topics::Command::kExport:
            return "export " + command.export_();
        case topics::Command::kResetDevice:
            return "reset the device";
        case topics::Command::kChooseScene:
            return "scene " + command.choose_scene();
        case topics::Command::kStartAttempt:
            return "attempt of " + command.start_attempt();
        case topics::Command::kStopAttempt:
            return "end the attempt";
        case topics::Command::kAddRemark:
            return command.add_remark().note().empty() ? "draw a stroke" : "write a note";
        case topics::Command::kEraseRemark:
            return command.erase_remark() == 0 ? "erase all notes and strokes"
                                               : "erase " + std::to_string(command.erase_remark());
        case topics::Command::kReplay:
            return replayText(command.replay());
        case topics::Command::ACTION_NOT_SET:
            break;
    }
    return "no action";
}

std::string outcomeText(const CommandOutcome& outcome) {
    return commandText(outcome.command) + ": " + outcome.result;
}

}  // namespace bonemill

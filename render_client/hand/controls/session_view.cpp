#include "render_client/hand/controls/session_view.h"

#include <algorithm>

#include "common/commands/role_rules.h"
#include "common/device_messages/device_messages.h"

namespace bonemill {
namespace {

CommandOrReason refuse(std::string why_not) {
    return {std::nullopt, std::move(why_not)};
}

CommandOrReason pauseOrGoOn(const SessionView& session) {
    topics::Command command;
    command.set_pause_milling(isReplay(session) ? session.status->replay().is_playing()
                                                : !(session.status && session.status->is_milling_paused()));
    return {command, ""};
}

// Each step of speed is a doubling, from where it stands.
CommandOrReason orderReplay(Action action, const SessionView& session) {
    constexpr double kStepS = 5, kSlowest = 0.125, kFastest = 16;
    if (!isReplay(session)) return refuse("This is no replay of a recorded session");
    topics::Command command;
    topics::ReplayOrder& order = *command.mutable_replay();
    const double now_s = session.status->session_s(), speed = session.status->replay().speed();
    switch (action) {
        case Action::kReplayBack:
            order.set_seek_s(std::max(0.0, now_s - kStepS));
            break;
        case Action::kReplayAhead:
            order.set_seek_s(now_s + kStepS);
            break;
        case Action::kReplaySlower:
            order.set_speed(std::max(kSlowest, speed / 2));
            break;
        case Action::kReplayFaster:
            order.set_speed(std::min(kFastest, speed * 2));
            break;
        default:
            order.set_jump(action == Action::kPreviousEvent ? -1 : 1);
    }
    return {command, ""};
}

CommandOrReason backToLastCheckpoint(const SessionView& session) {
    if (!session.status || session.status->checkpoints().empty())
        return refuse("there is no checkpoint yet: " + keyLabelOf(Action::kSaveCheckpoint) + " saves one");
    topics::Command command;
    command.set_restore_checkpoint(session.status->checkpoints().rbegin()->id());
    return {command, ""};
}

CommandOrReason nextTool(const SessionView& session) {
    const uint32_t count = session.info ? uint32_t(session.info->tool_names_size()) : 0;
    if (count < 2) return refuse("the scene has one tool only");
    topics::Command command;
    command.set_select_tool((session.info->tool_index() + 1) % count);
    return {command, ""};
}

// The one after the scene in force, of those that can be chosen.
CommandOrReason nextScene(const SessionView& session) {
    const int count = session.lesson ? session.lesson->scenes_size() : 0;
    int now = count - 1;
    for (int n = 0; n < count; ++n)
        if (session.lesson->scenes(n).id() == session.lesson->scene_id()) now = n;
    for (int step = 1; step <= count; ++step) {
        const topics::SceneChoice& scene = session.lesson->scenes((now + step) % count);
        if (!scene.problem().empty() || scene.id() == session.lesson->scene_id()) continue;
        topics::Command command;
        command.set_choose_scene(scene.id());
        return {command, ""};
    }
    return refuse("there is no other scene to choose");
}

CommandOrReason stopAttempt(const SessionView& session) {
    if (!session.lesson || !session.lesson->is_running()) return refuse("no attempt is under way");
    topics::Command command;
    command.set_stop_attempt(true);
    return {command, ""};
}

}  // namespace

std::string whyNotCommand(const SessionView& session) {
    if (!mayOrderAnything(session.role)) return "A viewer only looks: start with --role operator";
    if (!session.has_server) return "There is no server";
    return "";
}

bool isReplay(const SessionView& session) {
    return session.status && session.status->has_replay();
}

bool isHeldByMouse(const SessionView& session) {
    return session.status && session.status->has_device() &&
           session.status->device().kind() == uint32_t(DeviceKind::kPointer);
}

std::string whyNotHold(const SessionView& session) {
    const std::string why_not = whyNotCommand(session);
    if (!why_not.empty()) return why_not;
    if (isReplay(session)) return "This is a replay: nobody holds its tool";
    if (!mayHoldTool(session.role)) return "An examiner leaves the tool to others";
    for (const topics::Viewer& other : session.others)
        if (other.is_holding())
            return (other.name().empty() ? "Another viewer" : other.name()) + " holds the tool";
    if (session.status && session.status->has_device() && !isHeldByMouse(session))
        return session.status->device().name() +
               " holds the tool: device_daemon --device pointer gives it to the mouse";
    return "";
}

std::string whyNotPoint(const SessionView& session) {
    if (mayPoint(session.role)) return "";
    return "Only an instructor points: start with --role instructor";
}

std::string whyNotEndSession(const SessionView& session) {
    if (!mayOrder(session.role, topics::Command::kShutDown))
        return "Only an instructor ends the session: start with --role instructor";
    return whyNotCommand(session);
}

CommandOrReason commandOf(Action action, const SessionView& session) {
    topics::Command command;
    CommandOrReason asked;
    switch (action) {
        case Action::kResetBone:
            command.set_reset_volume(true);
            asked = {command, ""};
            break;
        case Action::kPauseMilling:
            asked = pauseOrGoOn(session);
            break;
        case Action::kReplayBack:
        case Action::kReplayAhead:
        case Action::kReplaySlower:
        case Action::kReplayFaster:
        case Action::kPreviousEvent:
        case Action::kNextEvent:
            asked = orderReplay(action, session);
            break;
        case Action::kSaveCheckpoint:
            command.set_save_checkpoint(true);
            asked = {command, ""};
            break;
        case Action::kLastCheckpoint:
            asked = backToLastCheckpoint(session);
            break;
        case Action::kNextTool:
            asked = nextTool(session);
            break;
        case Action::kNextScene:
            asked = nextScene(session);
            break;
        case Action::kStopAttempt:
            asked = stopAttempt(session);
            break;
        case Action::kResetDevice:
            command.set_reset_device(true);
            asked = {command, ""};
            break;
        case Action::kAccuracyScene:
        case Action::kAccuracy1:
        case Action::kAccuracy2:
        case Action::kAccuracy3:
        case Action::kAccuracy4:
            command.set_set_accuracy(std::string(accuracyOf(action)));
            asked = {command, ""};
            break;
        default:
            return {};
    }
    if (const std::string why_not = whyNotCommand(session); !why_not.empty()) return refuse(why_not);
    if (asked.command && !mayOrder(session.role, asked.command->action_case()))
        return refuse("An examiner leaves bone, tool and device to others");
    return asked;
}

}  // namespace bonemill

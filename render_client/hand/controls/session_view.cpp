#include "render_client/hand/controls/session_view.h"

#include <algorithm>

#include "common/commands/role_rules.h"
#include "common/device_messages/device_messages.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/figure_text.h"

namespace bonemill {
namespace {

constexpr const char* kNoEndedHand = trMark("no scripted hand has done all of its script");

std::string milledVolume(const SessionView& session) {
    return readableText(session.status->removed_mm3(), " mm\u00b3");
}

// A checkpoint has the bone as it is when just as much was removed until then.
bool hasUnsavedWork(const SessionView& session) {
    if (!session.status || session.status->removed_mm3() == 0) return false;
    for (const topics::Checkpoint& checkpoint : session.status->checkpoints())
        if (checkpoint.removed_mm3() == session.status->removed_mm3()) return false;
    return true;
}

bool isAttemptRunning(const SessionView& session) {
    return session.lesson && session.lesson->is_running();
}

std::optional<Question> beforeScene(const SessionView& session) {
    std::string lost;
    if (isAttemptRunning(session)) lost += tr(" {1}'s attempt ends.", {session.lesson->trainee()});
    if (session.status && session.status->removed_mm3() > 0)
        lost += tr(" {1} are milled and go with it.", {milledVolume(session)});
    if (lost.empty()) return std::nullopt;
    return Question{tr("Change the exercise?") + lost, tr("Change")};
}

std::optional<Question> beforeOtherBone(const topics::Command& command, const SessionView& session) {
    if (!hasUnsavedWork(session)) return std::nullopt;
    const bool is_checkpoint = command.has_restore_checkpoint();
    const std::string what =
        is_checkpoint ? tr("Back to checkpoint {1}?", {std::to_string(command.restore_checkpoint())})
                      : tr("Put the bone back?");
    return Question{.text = tr("{1} {2} are milled and in no checkpoint.", {what, milledVolume(session)}),
                    .yes = is_checkpoint ? tr("Go back") : tr("Put back"),
                    .offers_checkpoint = true};
}

std::optional<Question> beforeCommand(const topics::Command& command, const SessionView& session) {
    if (command.has_choose_scene()) return beforeScene(session);
    if (command.has_start_attempt()) {
        if (!isAttemptRunning(session)) return std::nullopt;
        return Question{tr("End {1}'s attempt? {2} begins on whole bone.",
                           {session.lesson->trainee(), command.start_attempt()}),
                        tr("Begin anew")};
    }
    if (command.has_erase_remark() && command.erase_remark() == 0)
        return Question{tr("Erase all notes and strokes, for everybody?"), tr("Erase")};
    const bool is_work_lost = command.begin_again() && isTakenOver(session);  // a script does its own again
    if (command.reset_volume() || command.has_restore_checkpoint() || is_work_lost)
        return beforeOtherBone(command, session);
    return std::nullopt;
}

CommandOrReason refuse(std::string why_not) {
    return {std::nullopt, std::move(why_not)};
}

template <class Value>
CommandOrReason order(void (topics::Command::*set)(Value), std::type_identity_t<Value> value) {
    return {commandWith(set, value), ""};
}

CommandOrReason pauseOrGoOn(const SessionView& session) {
    return order(&topics::Command::set_pause_milling,
                 isReplay(session) ? session.status->replay().is_playing()
                                   : !(session.status && session.status->is_milling_paused()));
}

// Each step of speed is a doubling, from where it stands.
CommandOrReason orderReplay(Action action, const SessionView& session) {
    constexpr double kStepS = 5, kSlowest = 0.125, kFastest = 16;
    if (!isReplay(session)) return refuse(tr("This is no replay of a recorded session"));
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
        return refuse(tr("there is no checkpoint yet: {1} saves one", {keyLabelOf(Action::kSaveCheckpoint)}));
    return order(&topics::Command::set_restore_checkpoint, session.status->checkpoints().rbegin()->id());
}

CommandOrReason nextTool(const SessionView& session) {
    const uint32_t count = session.info ? uint32_t(session.info->tool_names_size()) : 0;
    if (count < 2) return refuse(tr("the scene has one tool only"));
    return order(&topics::Command::set_select_tool, (session.info->tool_index() + 1) % count);
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
    return refuse(tr("there is no other scene to choose"));
}

CommandOrReason stopAttempt(const SessionView& session) {
    if (!session.lesson || !session.lesson->is_running()) return refuse(tr("no attempt is under way"));
    return order(&topics::Command::set_stop_attempt, true);
}

CommandOrReason beginAgain(const SessionView& session) {
    if (!hasHandEnded(session) && !isTakenOver(session)) return refuse(tr(kNoEndedHand));
    return order(&topics::Command::set_begin_again, true);
}

CommandOrReason askedBy(Action action, const SessionView& session) {
    topics::Command command;
    switch (action) {
        case Action::kResetBone:
            return order(&topics::Command::set_reset_volume, true);
        case Action::kPauseMilling:
            return pauseOrGoOn(session);
        case Action::kReplayBack:
        case Action::kReplayAhead:
        case Action::kReplaySlower:
        case Action::kReplayFaster:
        case Action::kPreviousEvent:
        case Action::kNextEvent:
            return orderReplay(action, session);
        case Action::kSaveCheckpoint:
            return order(&topics::Command::set_save_checkpoint, true);
        case Action::kLastCheckpoint:
            return backToLastCheckpoint(session);
        case Action::kNextTool:
            return nextTool(session);
        case Action::kNextScene:
            return nextScene(session);
        case Action::kStopAttempt:
            return stopAttempt(session);
        case Action::kResetDevice:
            return order(&topics::Command::set_reset_device, true);
        case Action::kAgain:
            return beginAgain(session);
        case Action::kAccuracyScene:
        case Action::kAccuracy1:
        case Action::kAccuracy2:
        case Action::kAccuracy3:
        case Action::kAccuracy4:
            command.set_set_accuracy(std::string(accuracyOf(action)));
            return {command, ""};
        default:
            return {};
    }
}

}  // namespace

bool isSame(const Deed& a, const Deed& b) {
    return a.kind == b.kind && a.command.SerializeAsString() == b.command.SerializeAsString();
}

std::optional<Question> questionBefore(const Deed& deed, const SessionView& session) {
    switch (deed.kind) {
        case Deed::Kind::kCommand:
            return beforeCommand(deed.command, session);
        case Deed::Kind::kNextTrainee:
            if (!isAttemptRunning(session)) return std::nullopt;
            return Question{tr("Next trainee? {1}'s attempt ends.", {session.lesson->trainee()}),
                            tr("End it")};
        case Deed::Kind::kQuit:
            return Question{tr("Close this viewer?"), tr("Close")};
    }
    return std::nullopt;
}

bool wantsCheckpointBefore(const Deed& deed, const SessionView& session) {
    return deed.command.has_start_attempt() && !isAttemptRunning(session) && hasUnsavedWork(session);
}

std::string whyNotCommand(const SessionView& session) {
    if (!mayOrderAnything(session.role)) return tr("A viewer only looks: start with --role operator");
    if (!session.has_server) return tr("There is no server");
    return "";
}

bool isReplay(const SessionView& session) {
    return session.status && session.status->has_replay();
}

bool isHeldByMouse(const SessionView& session) {
    return session.status && session.status->has_device() &&
           session.status->device().kind() == uint32_t(DeviceKind::kPointer);
}

bool hasHandEnded(const SessionView& session) {
    return session.status && !isReplay(session) && session.status->device().script().has_ended();
}

bool isTakenOver(const SessionView& session) {
    return session.status && !isReplay(session) && session.status->device().script().taken_over_by() != 0;
}

std::string whyNotTakeOver(const SessionView& session) {
    if (const std::string why_not = whyNotCommand(session); !why_not.empty()) return why_not;
    if (!mayHoldTool(session.role)) return tr("An examiner leaves the tool to others");
    return hasHandEnded(session) ? "" : tr(kNoEndedHand);
}

std::string whyNotHold(const SessionView& session) {
    const std::string why_not = whyNotCommand(session);
    if (!why_not.empty()) return why_not;
    if (isReplay(session)) return tr("This is a replay: nobody holds its tool");
    if (!mayHoldTool(session.role)) return tr("An examiner leaves the tool to others");
    for (const topics::Viewer& other : session.others)
        if (other.is_holding())
            return other.name().empty() ? tr("Another viewer holds the tool")
                                        : tr("{1} holds the tool", {other.name()});
    if (session.status && session.status->has_device() && !isHeldByMouse(session))
        return tr("{1} holds the tool: device_daemon --device pointer gives it to the mouse",
                  {session.status->device().name()});
    return "";
}

std::string whyNotPoint(const SessionView& session) {
    if (mayPoint(session.role)) return "";
    return tr("Only an instructor points: start with --role instructor");
}

std::string whyNotEndSession(const SessionView& session) {
    if (!mayOrder(session.role, topics::Command::kShutDown))
        return tr("Only an instructor ends the session: start with --role instructor");
    return whyNotCommand(session);
}

CommandOrReason commandOf(Action action, const SessionView& session) {
    const CommandOrReason asked = askedBy(action, session);
    if (!asked.command && asked.why_not.empty()) return asked;
    if (const std::string why_not = whyNotCommand(session); !why_not.empty()) return refuse(why_not);
    if (asked.command && !mayOrder(session.role, asked.command->action_case()))
        return refuse(tr("An examiner leaves bone, tool and device to others"));
    return asked;
}

}  // namespace bonemill

#include "render_client/hand/controls/question.h"

#include "render_client/look/hud/figure_text.h"

namespace bonemill {
namespace {

std::string milledText(const SessionView& session) {
    return readableText(session.status->removed_mm3(), " mm\u00b3") + " are milled";
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

std::string attemptText(const SessionView& session) {
    return session.lesson->trainee() + "'s attempt";
}

std::optional<Question> beforeScene(const SessionView& session) {
    std::string lost;
    if (isAttemptRunning(session)) lost += " " + attemptText(session) + " ends.";
    if (session.status && session.status->removed_mm3() > 0)
        lost += " " + milledText(session) + " and go with it.";
    if (lost.empty()) return std::nullopt;
    return Question{"Change the exercise?" + lost, "Change"};
}

std::optional<Question> beforeOtherBone(const topics::Command& command, const SessionView& session) {
    if (!hasUnsavedWork(session)) return std::nullopt;
    const std::string what = command.reset_volume()
                                 ? "Put the bone back?"
                                 : "Back to checkpoint " + std::to_string(command.restore_checkpoint()) + "?";
    return Question{.text = what + " " + milledText(session) + " and in no checkpoint.",
                    .yes = command.reset_volume() ? "Put back" : "Go back",
                    .offers_checkpoint = true};
}

std::optional<Question> beforeCommand(const topics::Command& command, const SessionView& session) {
    if (command.has_choose_scene()) return beforeScene(session);
    if (command.has_start_attempt()) {
        if (!isAttemptRunning(session)) return std::nullopt;
        return Question{
            "End " + attemptText(session) + "? " + command.start_attempt() + " begins on whole bone.",
            "Begin anew"};
    }
    if (command.has_erase_remark() && command.erase_remark() == 0)
        return Question{"Erase all notes and strokes, for everybody?", "Erase"};
    if (command.reset_volume() || command.has_restore_checkpoint()) return beforeOtherBone(command, session);
    return std::nullopt;
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
            return Question{"Next trainee? " + attemptText(session) + " ends.", "End it"};
        case Deed::Kind::kQuit:
            return Question{"Close this viewer?", "Close"};
    }
    return std::nullopt;
}

bool wantsCheckpointBefore(const Deed& deed, const SessionView& session) {
    return deed.command.has_start_attempt() && !isAttemptRunning(session) && hasUnsavedWork(session);
}

}  // namespace bonemill

#include "haptic_server/lab/stepping/recorded_run.h"

#include "common/base/user_error.h"

namespace bonemill {

RecordedRun::RecordedRun(const Recording& recording)
    : SteppedRun(recording.scene()), recording_(recording), bones_(recording.readBones(bone())) {
    if (!bones_.problem.empty()) throw UserError(recording.path().string() + ": " + bones_.problem);
    makeRerun();
}

void RecordedRun::makeRerun() {
    rerun_ = std::make_unique<Rerun>(recording_, setup(), bones_.checkpoints, *ownSetup().bone,
                                     bones_.keyframes.front());
}

void RecordedRun::restart() {
    rerun_.reset();
    beginAnew();
    makeRerun();
}

const TickRecord& RecordedRun::stepAsRecorded() {
    if (rerun_->hasLeft())
        throw UserError(recording_.path().string() +
                        ": another hand has gone on; restart() to follow it again");
    if (rerun_->isAtEnd())
        throw UserError(recording_.path().string() + ": ends after " + std::to_string(recording_.ticks()) +
                        " ticks");
    const TickRecord& record = note(rerun_->step());
    if (rerun_->isBonePutBack()) noteAllChanged();
    return record;
}

void RecordedRun::chooseTool(size_t tool) {
    if (tool >= rerun_->tools().count())
        throw UserError("there is no tool " + std::to_string(tool) + ": the scene has " +
                        std::to_string(rerun_->tools().count()));
    rerun_->tools().choose(tool);
}

const TickRecord& RecordedRun::tick(const HandStep& hand) {
    if (hand.t_s) throw UserError("a replay has its own times: leave t_s out");
    const TickRecord& record = rerun_->step(hand.X_WT, hand.buttons);
    if (rerun_->isBonePutBack()) noteAllChanged();
    return record;
}

}  // namespace bonemill

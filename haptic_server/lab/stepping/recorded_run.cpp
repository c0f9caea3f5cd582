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

Rerun& RecordedRun::rerun() const {
    if (!rerun_) throw UserError("this run is half way between two states: restart() it");
    return *rerun_;
}

void RecordedRun::restart() {
    rerun_.reset();
    beginAnew();
    makeRerun();
}

const TickRecord& RecordedRun::stepAsRecorded() {
    if (rerun().hasLeft())
        throw UserError(recording_.path().string() +
                        ": another hand has gone on; restart() to follow it again");
    if (rerun().isAtEnd())
        throw UserError(recording_.path().string() + ": ends after " + std::to_string(recording_.ticks()) +
                        " ticks");
    const TickRecord& record = note(rerun().step());
    if (rerun().isBonePutBack()) noteAllChanged();
    return record;
}

void RecordedRun::chooseTool(size_t tool) {
    if (tool >= rerun().tools().count())
        throw UserError("there is no tool " + std::to_string(tool) + ": the scene has " +
                        std::to_string(rerun().tools().count()));
    rerun().tools().choose(tool);
}

const TickRecord& RecordedRun::tick(const HandStep& hand) {
    if (hand.t_s) throw UserError("a replay has its own times: leave t_s out");
    const TickRecord& record = rerun().step(hand.X_WT, hand.buttons);
    if (rerun().isBonePutBack()) noteAllChanged();
    return record;
}

}  // namespace bonemill

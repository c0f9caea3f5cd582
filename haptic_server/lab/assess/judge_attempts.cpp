#include "haptic_server/lab/assess/judge_attempts.h"

namespace bonemill {

AttemptsJudge::AttemptsJudge(const Recording& recording, const std::vector<RecordedAttempt>& attempts)
    : recording_(recording),
      attempts_(attempts),
      loaded_(recording.scene()),
      simulation_(setUpScene(loaded_)),
      bones_(recording.readBones(*simulation_.bone)),
      eyes_(recordedEyes(recording)),
      rerun_(recording, simulation_, bones_.checkpoints, *simulation_.bone, bones_.keyframes.front()) {}

void AttemptsJudge::run(const std::function<void(const AttemptOutcome&)>& tell) {
    tell_ = tell;
    while (!rerun_.isAtEnd() && (run_ || next_ < attempts_.size())) {
        const uint64_t tick = rerun_.next();
        look(tick);
        follow(tick);
        const TickRecord& record = rerun_.step();
        if (run_ && record.bone_order >= attempts_[next_ - 1].bone_order) run_->add(record);
    }
    follow(rerun_.next());
    if (run_) end(rerun_.next() - 1);
}

// Who looks on from elsewhere tells of it some times per second; meanwhile the eye is where it was.
void AttemptsJudge::look(uint64_t tick) {
    const size_t before = next_eye_;
    while (next_eye_ < eyes_.size() && eyes_[next_eye_].tick <= tick) ++next_eye_;
    if (run_ && next_eye_ > before) tellEye();
}

void AttemptsJudge::tellEye() {
    if (next_eye_ > 0) run_->setEye(eyes_[next_eye_ - 1].p_WC);
}

// Before this tick: an attempt ends behind so many ticks. It begins with an order to put the bone back, which
// no tick has taken up yet.
void AttemptsJudge::follow(uint64_t tick) {
    endAt(tick);
    while (!run_ && next_ < attempts_.size() && attempts_[next_].begin <= tick) {
        ++next_;
        run_ = std::make_unique<TaskRun>(loaded_.scene, simulation_, true);
        tellEye();
        endAt(tick);
    }
}

void AttemptsJudge::endAt(uint64_t tick) {
    if (run_ && attempts_[next_ - 1].end <= tick) end(attempts_[next_ - 1].end);
}

void AttemptsJudge::end(uint64_t tick) {
    const RecordedAttempt& recorded = attempts_[next_ - 1];
    const double begin_s = recording_.secondsOf(recorded.begin);
    const double duration_s = recorded.time_s.value_or(recording_.secondsOf(tick) - begin_s);
    tell_({next_ - 1, begin_s, duration_s,
           run_->judgeBone(rerun_.history().scanned(), simulation_.bone->volume)});
    run_.reset();
}

}  // namespace bonemill

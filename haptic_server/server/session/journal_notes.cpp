#include "haptic_server/server/session/journal_notes.h"

#include "common/rt/clock.h"

namespace bonemill {
namespace {

// With what writing takes, no bone that was milled more than 250 ms ago is lost.
constexpr int64_t kBonePeriodNs = 150 * kNsPerMillisecond;

}  // namespace

void JournalRecorder::begin(Journal* journal, const Checkpoints& checkpoints) {
    journal_ = journal;
    if (!journal_) return;
    noteBone();
    for (const Checkpoints::Checkpoint& checkpoint : checkpoints.kept()) noteCheckpoint(checkpoint);
}

void JournalRecorder::noteBone() {
    last_bone_ns_ = monotonicNowNs();
    const uint64_t order = history_.finishedOrder();
    if (order != history_.newestOrder()) return;  // it is on its way to something that is known
    journal_->putBone(history_.snapshot(bone_), order);
}

void JournalRecorder::round() {
    if (journal_ && monotonicNowNs() - last_bone_ns_ >= kBonePeriodNs) noteBone();
}

void JournalRecorder::end() {
    if (journal_) noteBone();
}

void JournalRecorder::noteCheckpoint(const Checkpoints::Checkpoint& checkpoint) {
    if (journal_) journal_->putCheckpoint(checkpoint.snapshot, checkpoint.id, checkpoint.session_s);
}

void JournalRecorder::expectPutBack(uint32_t checkpoint) {
    if (!journal_) return;
    journal::PutBack put_back;
    put_back.set_bone_order(history_.newestOrder() + 1);
    put_back.set_checkpoint(checkpoint);
    journal_->put(JournalTopic::kPutBack, put_back);
}

void JournalRecorder::noteTuned(uint32_t number, const scene::Tuning& values) {
    if (!journal_) return;
    journal::Tuned tuned;
    tuned.set_number(number);
    *tuned.mutable_values() = values;
    journal_->put(JournalTopic::kTuned, tuned);
}

void JournalRecorder::noteOrder(const topics::Command& command, const std::string& result) {
    if (!journal_) return;
    journal::Order order;
    order.set_tick(journal_->ticks());
    *order.mutable_command() = command;
    order.set_result(result);
    journal_->put(JournalTopic::kOrder, order);
}

void JournalRecorder::noteEye(const SeenEye& eye) {
    if (!journal_) return;
    journal::Camera camera;
    camera.set_sender(eye.sender);
    camera.set_tick(journal_->ticks());
    topics::Eye& seen = *camera.mutable_eye();
    seen.mutable_p_wc_m()->Assign(eye.X_WC.position.begin(), eye.X_WC.position.end());
    const Eigen::Quaterniond& q = eye.X_WC.rotation;
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) seen.add_q_wc(part);
    seen.set_field_of_view_rad(eye.field_of_view);
    journal_->put(JournalTopic::kCamera, camera);
}

void JournalRecorder::noteAttemptBegan(const std::string& trainee, uint64_t bone_order) {
    if (!journal_) return;
    journal::Event event;
    event.set_tick(journal_->ticks());
    event.set_attempt_began(trainee);
    event.set_bone_order(bone_order);
    journal_->put(JournalTopic::kEvent, event);
}

void JournalRecorder::noteAttemptEnded(const topics::Attempt& attempt, uint64_t ticks) {
    if (!journal_) return;
    journal::Event event;
    event.set_tick(ticks);
    *event.mutable_attempt_ended() = attempt;
    journal_->put(JournalTopic::kEvent, event);
}

void JournalRecorder::noteAttemptDropped() {
    if (!journal_) return;
    journal::Event event;
    event.set_tick(journal_->ticks());
    event.mutable_attempt_dropped();
    journal_->put(JournalTopic::kEvent, event);
}

}  // namespace bonemill

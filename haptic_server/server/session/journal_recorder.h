// Tells the session's journal what the publisher thread knows: how the bone is, several times per second,
// what viewers ordered, and attempts. Without a journal it does nothing. All members belong to the publisher
// thread, or to whoever runs none beside it.
#pragma once

#include <string>
#include <utility>

#include "common/rt/clock.h"
#include "haptic_server/core/bone/checkpoints.h"
#include "haptic_server/recording/journal/journal.h"
#include "haptic_server/server/publish/trainee_eye.h"
#include "proto/topics.pb.h"

namespace bonemill {

class JournalRecorder {
  public:
    JournalRecorder(BoneHistory& history, const BoneModel& bone) : history_(history), bone_(bone) {}

    // From now on it goes there (null: nowhere); how the bone is now comes first.
    void begin(Journal* journal, const Checkpoints& checkpoints) {
        journal_ = journal;
        if (!journal_) return;
        noteBone();
        for (const Checkpoints::Checkpoint& checkpoint : checkpoints.kept()) noteCheckpoint(checkpoint);
    }

    // Some 200 times per second.
    void round() {
        if (journal_ && monotonicNowNs() - last_bone_ns_ >= kBonePeriodNs) noteBone();
    }
    // The bone as it is at the end, after the last tick.
    void end() {
        if (journal_) noteBone();
    }
    void noteCheckpoint(const Checkpoints::Checkpoint& checkpoint) {
        if (journal_) journal_->putCheckpoint(checkpoint.snapshot, checkpoint.id, checkpoint.session_s);
    }
    // Before the bone may be put back to this checkpoint: a tick that takes the order up is understood then.
    void expectPutBack(uint32_t checkpoint) {
        if (!journal_) return;
        journal::PutBack put_back;
        put_back.set_bone_order(history_.newestOrder() + 1);
        put_back.set_checkpoint(checkpoint);
        journal_->put(JournalTopic::kPutBack, put_back);
    }
    void noteOrder(const topics::Command& command, const std::string& result) {
        if (!journal_) return;
        journal::Order order;
        order.set_tick(journal_->ticks());
        *order.mutable_command() = command;
        order.set_result(result);
        journal_->put(JournalTopic::kOrder, order);
    }
    // What the trainee sees now.
    void noteEye(const SeenEye& eye) {
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
    // It begins when this order to put the bone back is done.
    void noteAttemptBegan(const std::string& trainee, uint64_t bone_order) {
        journal::Event event;
        event.set_attempt_began(trainee);
        event.set_bone_order(bone_order);
        note(std::move(event));
    }
    void noteAttemptEnded(const topics::Attempt& attempt) {
        journal::Event event;
        *event.mutable_attempt_ended() = attempt;
        note(std::move(event));
    }
    void noteAttemptDropped() {
        journal::Event event;
        event.mutable_attempt_dropped();
        note(std::move(event));
    }
    // Of the recording; empty if there is none.
    std::string fileName() const { return journal_ ? journal_->path().filename().string() : ""; }

  private:
    // With what writing takes, no bone that was milled more than 250 ms ago is lost.
    static constexpr int64_t kBonePeriodNs = 150 * kNsPerMillisecond;

    void note(journal::Event event) {
        if (!journal_) return;
        event.set_tick(journal_->ticks());
        journal_->put(JournalTopic::kEvent, event);
    }
    void noteBone() {
        last_bone_ns_ = monotonicNowNs();
        const uint64_t order = history_.finishedOrder();
        if (order != history_.newestOrder()) return;  // it is on its way to something that is known
        journal_->putBone(history_.snapshot(bone_), order);
    }

    BoneHistory& history_;
    const BoneModel& bone_;
    Journal* journal_ = nullptr;
    int64_t last_bone_ns_ = 0;
};

}  // namespace bonemill

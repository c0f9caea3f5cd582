// Tells the session's journal what the publisher thread knows: how the bone is, several times per second,
// what viewers ordered, and attempts. Without a journal it does nothing. All members belong to the publisher
// thread, or to whoever runs none beside it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "haptic_server/core/bone/checkpoints.h"
#include "haptic_server/recording/journal/journal.h"
#include "haptic_server/server/publish/trainee_eye.h"
#include "proto/topics.pb.h"

namespace bonemill {

class JournalRecorder {
  public:
    JournalRecorder(BoneHistory& history, const BoneModel& bone) : history_(history), bone_(bone) {}

    // From now on it goes there (null: nowhere); how the bone is now comes first.
    void begin(Journal* journal, const Checkpoints& checkpoints);

    // Some 200 times per second.
    void round();
    // The bone as it is at the end, after the last tick.
    void end();
    void noteCheckpoint(const Checkpoints::Checkpoint& checkpoint);
    // Before the bone may be put back to this checkpoint: a tick that takes the order up is understood then.
    void expectPutBack(uint32_t checkpoint);
    // Before a tick may take it up.
    void noteTuned(uint32_t number, const scene::Tuning& values);
    void noteOrder(const topics::Command& command, const std::string& result);
    // What the trainee sees now.
    void noteEye(const SeenEye& eye);
    // It begins when this order to put the bone back is done.
    void noteAttemptBegan(const std::string& trainee, uint64_t bone_order);
    // Behind so many ticks of the recording.
    void noteAttemptEnded(const topics::Attempt& attempt, uint64_t ticks);
    void noteAttemptDropped();
    // Of the recording; null if there is none.
    std::shared_ptr<const NewestLink> newestLink() const {
        return journal_ ? journal_->newestLink() : nullptr;
    }
    // Of the recording; empty if there is none.
    std::string fileName() const { return journal_ ? journal_->path().filename().string() : ""; }

  private:
    void noteBone();

    BoneHistory& history_;
    const BoneModel& bone_;
    Journal* journal_ = nullptr;
    int64_t last_bone_ns_ = 0;
};

}  // namespace bonemill

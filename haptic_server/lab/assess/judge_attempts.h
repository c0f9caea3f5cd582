// Runs a recording again and judges attempts in it as a live session would have. For one normal thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "haptic_server/lab/simulate/task_run.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/rerun/rerun.h"

namespace bonemill {

struct AttemptOutcome {
    size_t index;                        // of the attempts asked for
    double begin_s = 0, duration_s = 0;  // of the session; without pauses, where that was recorded
    TaskRun::Result result;
};

class AttemptsJudge {
  public:
    // Attempts in their order. All must outlive this object. Throws UserError.
    AttemptsJudge(const Recording& recording, const std::vector<RecordedAttempt>& attempts);

    // Tells of each when it has ended; one that did not ends with the recording.
    void run(const std::function<void(const AttemptOutcome&)>& tell);

    const LoadedScene& loaded() const noexcept { return loaded_; }

  private:
    void look(uint64_t tick);
    void tellEye();
    void follow(uint64_t tick);
    void endAt(uint64_t tick);
    void end(uint64_t tick);

    const Recording& recording_;
    const std::vector<RecordedAttempt>& attempts_;
    LoadedScene loaded_;
    SceneSetup simulation_;
    Recording::Bones bones_;
    std::vector<RecordedEye> eyes_;
    Rerun rerun_;
    std::function<void(const AttemptOutcome&)> tell_;
    std::unique_ptr<TaskRun> run_;  // of the attempt that is on
    size_t next_ = 0;               // attempt
    size_t next_eye_ = 0;
};

}  // namespace bonemill

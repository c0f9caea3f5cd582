// The other attempt beside a replay: runs its ticks again, on a bone of its own, to wherever the replay
// stands.
//
// It belongs to one normal thread; the mesher may read its bone meanwhile.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "common/geometry/pose.h"
#include "haptic_server/server/replay/attempt_clock.h"
#include "haptic_server/server/replay/compared_attempt.h"
#include "haptic_server/server/replay/survey.h"

namespace bonemill {

class Companion {
  public:
    // `scanned` is the bone before anything has changed it; all but the first must outlive this object.
    // Throws UserError.
    Companion(ComparedAttempt compared, const Recording& shown, const SceneSetup& simulation,
              const LoadedScene& scene, const VoxelVolume& scanned);

    // Goes to where it stands while the replay shows this tick, for so long at most; true: it is there. What
    // lies far ahead, or behind, it reaches from the state of the bone before it.
    bool follow(uint64_t shown_tick, std::chrono::nanoseconds limit, const std::stop_token& stop);

    const std::string& text() const noexcept { return compared_.text; }
    // Of the attempt, s: where it stands, and its length.
    double attemptS() const { return clock_.attemptS(now()); }
    double lengthS() const { return clock_.lengthS(); }
    // So far it is from where it was to go last, s of its recording.
    double awayS() const;
    // Of its tool, after the tick that was run last; nothing before any was.
    const std::optional<Pose>& X_WT() const noexcept { return X_WT_; }
    std::shared_ptr<const BoneModel> bone() const noexcept { return bone_; }

  private:
    uint64_t now() const { return rerun_.next() == 0 ? 0 : rerun_.next() - 1; }
    void step();

    ComparedAttempt compared_;
    AttemptClock clock_;
    std::shared_ptr<BoneModel> bone_;
    Recording::Bones bones_;
    Keyframes keyframes_;
    Rerun rerun_;
    const double rate_hz_;
    uint64_t goal_ = 0;  // tick of the other recording
    std::optional<Pose> X_WT_;
};

}  // namespace bonemill

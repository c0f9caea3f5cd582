// A recorded session run again tick by tick, to its bits; at any tick another hand may go on.
#pragma once

#include <filesystem>
#include <optional>

#include "haptic_server/lab/stepping/stepped_run.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/rerun/rerun.h"

namespace bonemill {

class RecordedRun final : public SteppedRun {
  public:
    // The scene's files must be those that the session milled. `recording` must outlive this object. Throws
    // UserError.
    explicit RecordedRun(const Recording& recording);

    const Recording& recording() const noexcept { return recording_; }
    // Its next tick runs as it did, unless another hand has gone on, or there is none: then it throws
    // UserError.
    const TickRecord& stepAsRecorded();
    using SteppedRun::step;  // with another hand
    bool hasLeft() const noexcept { return rerun_->hasLeft(); }
    // The recorded tick that stepAsRecorded() runs.
    uint64_t next() const noexcept { return rerun_->next(); }
    bool isAtEnd() const noexcept { return rerun_->isAtEnd(); }
    // An order has begun to put the bone back, and is not done.
    bool isRestoring() const noexcept { return rerun_->history().isRestoring(); }
    // Back to its first tick.
    void restart();

    size_t tool() const noexcept override { return rerun_->tools().chosen(); }
    // Another hand goes on with it.
    void chooseTool(size_t tool) override;

  private:
    const TickRecord& tick(const HandStep& hand) override;
    void makeRerun();

    const Recording& recording_;
    Recording::Bones bones_;
    std::unique_ptr<Rerun> rerun_;
};

}  // namespace bonemill

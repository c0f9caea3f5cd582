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
    bool hasLeft() const { return rerun().hasLeft(); }
    // The recorded tick that stepAsRecorded() runs.
    uint64_t next() const { return rerun().next(); }
    bool isAtEnd() const { return rerun().isAtEnd(); }
    // An order has begun to put the bone back, and is not done.
    bool isRestoring() const { return rerun().history().isRestoring(); }
    // Back to its first tick. After an exception, as one for want of memory, all that asks for ticks throws
    // UserError until it gets through.
    void restart();

    size_t tool() const override { return rerun().tools().chosen(); }
    // Another hand goes on with it.
    void chooseTool(size_t tool) override;

  private:
    const TickRecord& tick(const HandStep& hand) override;
    void makeRerun();
    Rerun& rerun() const;

    const Recording& recording_;
    Recording::Bones bones_;
    std::unique_ptr<Rerun> rerun_;  // null: it is half way between two states
};

}  // namespace bonemill

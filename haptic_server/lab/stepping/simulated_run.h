// A run from the scanned bone on, by a hand that the caller has: the tick of a live session, without a
// device, a clock or other processes. Equal hands give equal bits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "haptic_server/core/tick/haptic_tick.h"
#include "haptic_server/lab/stepping/stepped_run.h"

namespace bonemill {

// What a run has done so far: restoring it runs these ticks again, and so comes to the same bits. It never
// changes; 72 bytes a tick.
class RunCheckpoint {
  public:
    uint64_t ticks() const noexcept { return ticks_->size(); }

  private:
    friend class SimulatedRun;
    // Packed: of a long run there are many.
    struct Done {
        double p_WT[3], q_WT[4];  // w, x, y, z
        double t_s;               // NaN: it has none of its own
        uint32_t buttons, tool;
    };
    static_assert(sizeof(Done) == 72);
    std::shared_ptr<const std::vector<Done>> ticks_;
    uint32_t tool_ = 0;        // of the next tick
    uint64_t scene_hash_ = 0;  // whose checkpoint it is
};

class SimulatedRun final : public SteppedRun {
  public:
    // Whoever wants no checkpoint spares the memory for it. Throws UserError.
    SimulatedRun(const LoadedScene& loaded, size_t first_tool = 0, bool keeps_inputs = true);
    ~SimulatedRun() override;

    // The bone as scanned, and no tick: some hundredth of a second to some seconds, by the bone's size. After
    // an exception, as one for want of memory, there are no ticks and no checkpoints until one of these two
    // gets through: they throw UserError.
    void reset();
    // Takes as long as its ticks did, or those from here on if this run has come this far by the same ones
    // and was not judged. Calls after_tick after each; what that throws ends it half way. Throws UserError,
    // and all is as before, if it is of another scene.
    void restore(const RunCheckpoint& checkpoint, const std::function<void()>& after_tick = {});
    // Throws UserError if inputs are not kept.
    RunCheckpoint checkpoint() const;

    size_t tool() const override { return tools_.chosen(); }
    void chooseTool(size_t tool) override;

  private:
    const TickRecord& tick(const HandStep& hand) override;
    void makeTick();
    void requireWhole() const;
    void runAgain(const RunCheckpoint& checkpoint, const std::function<void()>& after_tick);
    void keep(const HandStep& hand);

    size_t first_tool_;
    bool keeps_inputs_;
    bool has_own_times_ = false;  // the caller's, from some tick on
    ToolSwitch tools_;
    AccuracySwitch accuracy_;
    std::unique_ptr<HapticTick> tick_;  // null: it is half way between two states
    std::vector<RunCheckpoint::Done> done_;
};

}  // namespace bonemill

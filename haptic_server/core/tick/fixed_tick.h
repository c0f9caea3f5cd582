// This tick has one tool and one accuracy; nobody chooses others.
#pragma once

#include "haptic_server/core/tick/haptic_tick.h"

namespace bonemill {

class FixedTick {
  public:
    // Does as HapticTick's constructor. The tool's model must outlive this object.
    FixedTick(const FixedTickConfig& config, BoneModel& bone, BoneHistory* history = nullptr)
        : tools_({config.tool}),
          accuracy_(config.accuracy),
          tick_(config, {bone, history}, {tools_, accuracy_}) {}

    const TickRecord* tick(TickIo& io) noexcept { return tick_.tick(io); }
    // Goes on to the end of the input, with take(record) after each tick.
    template <class Take>
    void run(TickIo& io, Take take) {
        while (const TickRecord* record = tick(io)) take(*record);
    }
    HapticTick& whole() noexcept { return tick_; }

  private:
    ToolSwitch tools_;
    AccuracySwitch accuracy_;
    HapticTick tick_;
};

}  // namespace bonemill

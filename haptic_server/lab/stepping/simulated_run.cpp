#include "haptic_server/lab/stepping/simulated_run.h"

#include <algorithm>

#include "common/base/user_error.h"
#include "haptic_server/core/tick/tick_once.h"

namespace bonemill {

SimulatedRun::SimulatedRun(const LoadedScene& loaded, size_t first_tool, bool keeps_inputs)
    : SteppedRun(loaded),
      first_tool_(first_tool),
      keeps_inputs_(keeps_inputs),
      tools_(setup().spoTools(), first_tool),
      accuracy_(setup().accuracy) {
    makeTick();
}

SimulatedRun::~SimulatedRun() = default;

void SimulatedRun::makeTick() {
    tools_.choose(first_tool_);
    done_.clear();
    tick_ = std::make_unique<HapticTick>(setup().tick, TickBone{*ownSetup().bone},
                                         TickChoices{tools_, accuracy_});
}

void SimulatedRun::reset() {
    tick_.reset();
    beginAnew();
    makeTick();
}

void SimulatedRun::chooseTool(size_t tool) {
    if (tool >= tools_.count())
        throw UserError("there is no tool " + std::to_string(tool) + ": the scene has " +
                        std::to_string(tools_.count()));
    tools_.choose(tool);
}

const TickRecord& SimulatedRun::tick(const HandStep& hand) {
    if (keeps_inputs_) done_.push_back({hand, uint32_t(tools_.chosen())});
    DeviceInput input;
    input.X_WT_device = hand.X_WT;
    input.buttons = hand.buttons;
    input.t_s = double(ticks()) * setup().tick.dt;
    return tickOnce(*tick_, input);
}

RunCheckpoint SimulatedRun::checkpoint() const {
    if (!keeps_inputs_) throw UserError("this run keeps no inputs, so it has no checkpoints");
    RunCheckpoint checkpoint;
    checkpoint.ticks_ = std::make_shared<const std::vector<RunCheckpoint::Done>>(done_);
    return checkpoint;
}

void SimulatedRun::restore(const RunCheckpoint& checkpoint) {
    if (!keeps_inputs_) throw UserError("this run keeps no inputs, so it restores no checkpoint");
    const auto is_same = [](const RunCheckpoint::Done& a, const RunCheckpoint::Done& b) {
        return a.tool == b.tool && a.hand.buttons == b.hand.buttons &&
               a.hand.X_WT.position == b.hand.X_WT.position &&
               a.hand.X_WT.rotation.coeffs() == b.hand.X_WT.rotation.coeffs();
    };
    const std::vector<RunCheckpoint::Done>& wanted = *checkpoint.ticks_;
    if (done_.size() > wanted.size() || !std::equal(done_.begin(), done_.end(), wanted.begin(), is_same))
        reset();
    for (size_t n = done_.size(); n < wanted.size(); ++n) {
        tools_.choose(wanted[n].tool);
        step(wanted[n].hand);
    }
}

}  // namespace bonemill

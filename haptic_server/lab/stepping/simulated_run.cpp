#include "haptic_server/lab/stepping/simulated_run.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

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
    has_own_times_ = false;
    tick_ = std::make_unique<HapticTick>(setup().tick, TickBone{*ownSetup().bone},
                                         TickChoices{tools_, accuracy_});
}

void SimulatedRun::reset() {
    tick_.reset();
    beginAnew();
    makeTick();
}

void SimulatedRun::requireWhole() const {
    if (!tick_) throw UserError("this run is half way between two states: reset() or restore() it");
}

void SimulatedRun::chooseTool(size_t tool) {
    if (tool >= tools_.count())
        throw UserError("there is no tool " + std::to_string(tool) + ": the scene has " +
                        std::to_string(tools_.count()));
    tools_.choose(tool);
}

void SimulatedRun::keep(const HandStep& hand) {
    const Eigen::Vector3d& p = hand.X_WT.position;
    const Eigen::Quaterniond& q = hand.X_WT.rotation;
    done_.push_back({{p.x(), p.y(), p.z()},
                     {q.w(), q.x(), q.y(), q.z()},
                     hand.t_s.value_or(std::numeric_limits<double>::quiet_NaN()),
                     hand.buttons,
                     uint32_t(tools_.chosen())});
}

const TickRecord& SimulatedRun::tick(const HandStep& hand) {
    requireWhole();
    if (keeps_inputs_) keep(hand);
    DeviceInput input;
    input.X_WT_device = hand.X_WT;
    input.buttons = hand.buttons;
    has_own_times_ |= hand.t_s.has_value();
    const double next_s =
        has_own_times_ && ticks() > 0 ? record().t_s + setup().tick.dt : double(ticks()) * setup().tick.dt;
    input.t_s = hand.t_s.value_or(next_s);
    return tickOnce(*tick_, input);
}

RunCheckpoint SimulatedRun::checkpoint() const {
    if (!keeps_inputs_) throw UserError("this run keeps no inputs, so it has no checkpoints");
    requireWhole();
    RunCheckpoint checkpoint;
    checkpoint.ticks_ = std::make_shared<const std::vector<RunCheckpoint::Done>>(done_);
    checkpoint.tool_ = uint32_t(tools_.chosen());
    checkpoint.scene_hash_ = sceneHashOf(loaded().scene);
    return checkpoint;
}

void SimulatedRun::restore(const RunCheckpoint& checkpoint, const std::function<void()>& after_tick) {
    if (!keeps_inputs_) throw UserError("this run keeps no inputs, so it restores no checkpoint");
    const auto is_same = [](const RunCheckpoint::Done& a, const RunCheckpoint::Done& b) {
        using Bits = std::array<uint64_t, sizeof a / sizeof(uint64_t)>;
        return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
    };
    const std::vector<RunCheckpoint::Done>& wanted = *checkpoint.ticks_;
    if (checkpoint.scene_hash_ != sceneHashOf(loaded().scene))
        throw UserError("the checkpoint is of another scene, or of other settings");
    if (!tick_ || isJudged() || done_.size() > wanted.size() ||
        !std::equal(done_.begin(), done_.end(), wanted.begin(), is_same))
        reset();
    try {
        runAgain(checkpoint, after_tick);
    } catch (...) {
        tick_.reset();
        throw;
    }
}

void SimulatedRun::runAgain(const RunCheckpoint& checkpoint, const std::function<void()>& after_tick) {
    for (size_t n = done_.size(); n < checkpoint.ticks_->size(); ++n) {
        const RunCheckpoint::Done& done = (*checkpoint.ticks_)[n];
        HandStep hand;
        hand.X_WT = {Eigen::Vector3d(done.p_WT),
                     Eigen::Quaterniond(done.q_WT[0], done.q_WT[1], done.q_WT[2], done.q_WT[3])};
        hand.buttons = done.buttons;
        if (!std::isnan(done.t_s)) hand.t_s = done.t_s;
        tools_.choose(done.tool);
        step(hand);
        if (after_tick) after_tick();
    }
    tools_.choose(checkpoint.tool_);
}

}  // namespace bonemill

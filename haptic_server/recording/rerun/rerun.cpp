#include "haptic_server/recording/rerun/rerun.h"

#include <algorithm>

#include "common/base/units.h"
#include "common/rt/clock.h"

namespace bonemill {

// Hands one recorded tick in.
class Rerun::Io final : public TickIo {
  public:
    Io(const JournalTick& tick, const DeviceCapabilities* device) : tick_(tick), device_(device) {}

    bool read(DeviceInput& input) noexcept override {
        const TickInput& in = tick_.input;
        input.X_WT_device = {Eigen::Vector3d(in.p_WT),
                             Eigen::Quaterniond(in.q_WT[0], in.q_WT[1], in.q_WT[2], in.q_WT[3])};
        input.is_repeated = in.is_repeated;
        input.buttons = tick_.buttons;
        input.placements = in.placements;
        input.device = tick_.device;
        input.other_device = device_;
        input.faults = in.faults;
        input.stale_factor = in.stale_factor;
        input.is_stale = in.is_stale;
        input.periods = in.periods;
        input.t_s = secondsOfNs(tick_.start_ns);
        input.start_ns = monotonicNowNs();
        input.decisions = &in.decisions;
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return monotonicNowNs(); }
    int64_t now() noexcept override { return monotonicNowNs(); }

  private:
    const JournalTick& tick_;
    const DeviceCapabilities* device_;
};

Rerun::Rerun(const Recording& recording, const Simulation& simulation, const RecordedCheckpoints& checkpoints,
             BoneModel& bone, const Keyframe& start)
    : recording_(recording),
      checkpoints_(checkpoints),
      config_(simulation.tick),
      bone_(bone),
      history_(bone),
      tools_(simulation.spoTools()),
      accuracy_(simulation.accuracy),
      ticks_(recording) {
    if (start.bone) history_.startFrom(bone_, start.bone);
    next_ = start.tick;
    makeTick();
}

void Rerun::startAt(const Keyframe& keyframe) {
    tick_.reset();
    history_.restore(keyframe.bone);
    history_.restoreAll(bone_);
    next_ = keyframe.tick;
    makeTick();
}

void Rerun::makeTick() {
    const TickDecisions first = ticks_.at(std::min(next_, recording_.ticks() - 1)).input.decisions;
    choose(first);
    bone_order_ = next_ == 0 ? 0 : ticks_.at(next_ - 1).input.decisions.bone_order;
    if (next_ == 0 && !recording_.content().put_backs.contains(first.bone_order))
        bone_order_ = first.bone_order;
    done_order_ = bone_order_;
    is_device_told_ = false;
    tick_ = std::make_unique<HapticTick>(config_, TickBone{bone_, &history_}, TickChoices{tools_, accuracy_});
}

// What the journal names was checked against the scene's tools and the presets when it was read.
void Rerun::choose(const TickDecisions& decisions) {
    tools_.choose(std::min<size_t>(decisions.tool, tools_.count() - 1));
    accuracy_.choose(std::min<size_t>(decisions.accuracy, AccuracySwitch::count() - 1));
}

// The order was there when the tick took it up.
void Rerun::putBack(const TickDecisions& decisions) {
    if (decisions.bone_order == bone_order_) return;
    bone_order_ = decisions.bone_order;
    // Both are there: Recording::readBones() has seen to it.
    const auto order = recording_.content().put_backs.find(bone_order_);
    if (order == recording_.content().put_backs.end()) return;
    const auto checkpoint = checkpoints_.find(order->second);
    // As after an order that no tick took up: the same target, asked for once more, is a new order.
    history_.restore(std::make_shared<const BoneSnapshot>());
    history_.restore(checkpoint == checkpoints_.end() ? nullptr : checkpoint->second);
}

const TickRecord& Rerun::step() {
    JournalTick tick = ticks_.at(next_);
    choose(tick.input.decisions);
    tick.input.decisions.tool = uint32_t(tools_.chosen());
    tick.input.decisions.accuracy = uint32_t(accuracy_.choice());
    putBack(tick.input.decisions);
    const DeviceCapabilities* device = tick.input.has_other_device ? &tick.input.other_device : nullptr;
    if (!is_device_told_ && !device) device = recording_.deviceBefore(next_);
    is_device_told_ = true;
    const bool was_restoring = history_.isRestoring();
    Io io(tick, device);
    record_ = *tick_->tick(io);
    if (!history_.isRestoring()) done_order_ = bone_order_;
    record_.bone_order = done_order_;
    is_put_back_ = was_restoring;
    ++next_;
    return record_;
}

}  // namespace bonemill

#include "haptic_server/offline/journal_run.h"

#include <utility>

#include "common/rt/clock.h"
#include "common/user_error.h"

namespace bonemill {

bool JournalBones::add(const journal::Bone& bone) {
    if (!states_.add(bone)) return false;
    if (!states_.isComplete()) return true;
    if (bone.kind() != journal::Bone::OTHER && !beginning_ && bone.tick() == 0) beginning_ = states_.state();
    if (bone.checkpoint() != 0)
        checkpoints_[bone.checkpoint()] = {bone.checkpoint_session_s(), states_.state()};
    return true;
}

void JournalBones::add(const journal::PutBack& order) {
    put_backs_[order.bone_order()] = order.checkpoint();
}

PutBackTargets JournalBones::targets() const {
    PutBackTargets targets;
    for (const auto& [order, checkpoint] : put_backs_) {
        const auto found = checkpoints_.find(checkpoint);
        if (checkpoint != 0 && found == checkpoints_.end()) continue;  // refused; who misses it says so
        targets[order] = checkpoint == 0 ? nullptr : found->second.state;
    }
    return targets;
}

// One input goes in and its record comes out.
class JournalRun::Io final : public TickIo {
  public:
    void set(const JournalTick& tick) {
        const TickInput& from = tick.input;
        input_ = {};
        input_.X_WT_device.position = {from.p_WT[0], from.p_WT[1], from.p_WT[2]};
        input_.X_WT_device.rotation = {from.q_WT[0], from.q_WT[1], from.q_WT[2], from.q_WT[3]};
        input_.is_repeated = from.is_repeated;
        input_.buttons = tick.buttons;
        input_.placements = from.placements;
        input_.device = tick.device;
        other_device_ = from.other_device;
        input_.other_device = from.has_other_device ? &other_device_ : nullptr;
        input_.faults = from.faults;
        input_.stale_factor = from.stale_factor;
        input_.is_stale = from.is_stale;
        input_.periods = from.periods;
        input_.t_s = secondsOfNs(tick.start_ns);
        input_.start_ns = tick.start_ns;
        decisions_ = from.decisions;
        input_.decisions = &decisions_;
    }
    bool read(DeviceInput& input) noexcept override {
        input = input_;
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return input_.start_ns; }
    int64_t now() noexcept override { return input_.start_ns; }
    void push(const TickRecord& record) noexcept override { record_ = record; }
    const TickRecord& record() const noexcept { return record_; }

  private:
    DeviceInput input_;
    DeviceCapabilities other_device_{};
    TickDecisions decisions_;
    TickRecord record_{};
};

JournalRun::JournalRun(Simulation& simulation, PutBackTargets targets,
                       const std::shared_ptr<const BoneSnapshot>& beginning)
    : simulation_(simulation),
      history_(*simulation.bone),
      targets_(std::move(targets)),
      tools_(simulation.spoTools()),
      accuracy_(simulation.accuracy),
      io_(std::make_unique<Io>()),
      tick_(simulation.tick, {*simulation.bone, &history_}, {tools_, accuracy_}) {
    if (beginning && !beginning->leaves.empty()) history_.startFrom(*simulation.bone, beginning);
    order_ = history_.newestOrder();
}

JournalRun::~JournalRun() = default;

const TickRecord& JournalRun::run(const JournalTick& tick) {
    const TickDecisions& decisions = tick.input.decisions;
    if (decisions.tool >= tools_.count() || decisions.accuracy >= AccuracySwitch::count())
        throw UserError("the journal's tick " + std::to_string(tick.tick) +
                        " has a tool or an accuracy that the scene does not have; is it another scene?");
    if (decisions.bone_order != std::exchange(order_, decisions.bone_order)) {
        const auto target = targets_.find(order_);
        if (target == targets_.end())
            throw UserError("the journal does not say to what its tick " + std::to_string(tick.tick) +
                            " puts the bone back; it is damaged");
        // As an order that no tick took up: then the same target, asked for again, is a new order.
        history_.restore(std::make_shared<const BoneSnapshot>());
        history_.restore(target->second);
    }
    io_->set(tick);
    tick_.tick(*io_);
    return io_->record();
}

}  // namespace bonemill

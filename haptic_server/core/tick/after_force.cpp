// What a tick does when its force is out: it mills or puts bone back, and lets the effects finish.
#include <algorithm>

#include "haptic_server/core/tick/haptic_tick.h"

namespace bonemill {

// The clock decides whether there is time for it; a replay has it from then. What is put off is milled in one
// of the next ticks, along the way of all.
MillingResult HapticTick::mill(const DeviceInput& input, TickIo& io, uint32_t& faults) noexcept {
    const double used = input.shareGone(io.now());
    if (!input.decisions && may_mill_)
        decisions_.is_milling_put_off = !later_work_.fits(LaterWork::kMilling, used);
    if (decisions_.is_milling_put_off) {
        if (was_pedal_down_ || was_add_wanted_) faults |= kFaultMillingCutShort;
        unmilled_periods_ += input.periods;
        return {};
    }
    const MillingResult milled = millOrRestore(faults);
    unmilled_periods_ = decisions_.is_write_refused ? unmilled_periods_ + input.periods : 0;
    unmilled_periods_ = std::min(unmilled_periods_, LaterWork::kMostWaits);
    if (!milled.changed.isEmpty() && !was_add_wanted_)
        later_work_.took(LaterWork::kMilling, input.shareGone(io.now()) - used);
    return milled;
}

// Likewise.
const EffectRecord& HapticTick::finishEffects(const DeviceInput& input, TickIo& io) noexcept {
    const double used = input.shareGone(io.now());
    if (!input.decisions) decisions_.is_heat_put_off = !later_work_.fits(LaterWork::kHeat, used);
    const EffectRecord& record = effects_.finish(!decisions_.is_heat_put_off);
    if (!decisions_.is_heat_put_off) later_work_.took(LaterWork::kHeat, input.shareGone(io.now()) - used);
    return record;
}

MillingResult HapticTick::millOrRestore(uint32_t& faults) noexcept {
    if (!history_) return millWithEffects(faults);
    if (decisions_.is_write_refused || !history_->beginWrite(tick_)) {
        decisions_.is_write_refused = true;
        return {};
    }
    MillingResult milled;
    bool shell_is_complete = true;
    if (history_->restoreSome(bone_, shell_is_complete)) {
        waits_for_release_ = true;
        noteSuddenChange(SuddenChange::kBone);
        models_.forEach([](SpoModel& model) { model.expectOtherBone(); });
        effects_.restart(history_->isTargetScanned() ? Restart::kScanPutBack : Restart::kBonePutBack);
    } else {
        milled = millWithEffects(faults);
    }
    if (!shell_is_complete) faults |= kFaultShellOverflow;
    decisions_.bone_order = history_->takenUpOrder();
    history_->endWrite(milled.removed_voxels, milled.added_voxels);
    return milled;
}

// Bone that is put back around a burr at work is not cut before somebody wants it: the pedal is let go once,
// or the burr has left the bone by so much that no tremor leads there.
void HapticTick::keepWaiting(const SpoStep& step) noexcept {
    constexpr double kAway = 2;  // radii of the burr from its middle
    if (!waits_for_release_ || history_->finishedOrder() != history_->takenUpOrder()) return;
    waits_for_release_ = step.contacts > 0 || isInBone(X_VT_, kAway * tools_[tool_].burr.radius);
}

MillingResult HapticTick::millWithEffects(uint32_t& faults) noexcept {
    MillingResult milled;
    effects_.mill(bone_, milled);
    if (!milled.shell_is_complete) faults |= kFaultShellOverflow;
    if (!milled.has_room) faults |= kFaultVolumeFull;
    if (milled.is_cut_short) faults |= kFaultMillingCutShort;
    return milled;
}

}  // namespace bonemill

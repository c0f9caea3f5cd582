#include "haptic_server/server/session/scripted_hand.h"

namespace bonemill {
namespace {

constexpr char kNoEnd[] =
    "no scripted hand has done all of its script (device_daemon --device simulated --hold)";

}  // namespace

std::string ScriptedHand::whyNotAgain() const {
    return taken_over_by_ != 0 || hasEnded() ? "" : kNoEnd;
}

void ScriptedHand::beginAnew() {
    taken_over_by_ = 0;
    tell_device_(HandChoice::kOwn);
}

Answer ScriptedHand::takeOver(uint64_t sender) {
    if (taken_over_by_ != 0) return Answer::refused("the mouse is the hand already: hold the tool with it");
    if (!hasEnded()) return Answer::refused(kNoEnd);
    taken_over_by_ = sender;
    tell_device_(HandChoice::kPointer);
    return Answer::done();
}

void ScriptedHand::describe(topics::Device& device) const {
    const bool has_ended = hasEnded();
    if (!has_ended && taken_over_by_ == 0) return;
    device.mutable_script()->set_has_ended(has_ended);
    device.mutable_script()->set_taken_over_by(taken_over_by_);
}

bool ScriptedHand::hasEnded() const {
    const auto latest = recorder_.latest();
    return taken_over_by_ == 0 && latest && (latest->device.flags & kDeviceFlagScriptEnded);
}

}  // namespace bonemill

#include "tests/integration/device/force_watch.h"

#include <algorithm>

#include "common/rt/clock.h"

namespace bonemill::test {
namespace {

constexpr double kFelt = 0.1;  // N: less is no force
// The amplifiers of 500 Hz have forgotten a force after so many states, and a drive that is switched off
// tells so one state earlier than its motors.
constexpr int kStatesUntilGone = 5;
// While the ramp takes the force the server may ask for more, which the ramp takes, too.
constexpr double kMoreOnRamp = 1.1, kMoreOnRampForce = 0.2;  // of the largest, and N

}  // namespace

void ForceWatch::look(std::span<const WirePacket> packets) {
    for (const WirePacket& packet : packets) lookAt(packet);
}

void ForceWatch::lookAt(const WirePacket& packet) {
    packet.is_command ? lookAtCommand(packet) : lookAtState(packet);
}

void ForceWatch::lookAtCommand(const WirePacket& command) {
    if (command.session != session_) {
        session_ = command.session;
        last_with_force_ = 0;
        states_without_force_ = 0;
    }
    if (command.is_engaged && !is_engaged_) {
        ++engagements_;
        if (!is_pressed_) ++unasked_engagements_;
        largest_ = 0;
    }
    if (!command.is_engaged && is_engaged_) {
        is_pressed_ = false;
        left_ns_ = command.host_ns;
        on_states_ = 0;
        if (ordered_ > kFelt) ++ramps_;
    }
    is_engaged_ = command.is_engaged;
    // The period of this command began after the one before was sent, however late the daemon is.
    const double since = secondsOfNs(newest_ns_ - left_ns_);
    newest_ns_ = command.host_ns;
    ordered_ = command.force;
    if (ordered_ > 0) last_with_force_ = command.sequence;
    if (is_engaged_) {
        largest_ = std::max(largest_, ordered_);
        return;
    }
    if (since > ramp_ && ordered_ > 0)
        complain("ordered more than " + std::to_string(since) + " s after the hand was let go", ordered_);
    if (ordered_ > kMoreOnRamp * largest_ + kMoreOnRampForce)
        complain("the force grows on its way out", ordered_);
}

void ForceWatch::lookAtState(const WirePacket& state) {
    if (state.holds_switch && !was_held_) is_pressed_ = true;
    was_held_ = state.holds_switch;
    on_states_ = state.is_on ? on_states_ + 1 : 0;
    off_states_ = state.is_on ? 0 : off_states_ + 1;
    const bool has_force = state.session == session_ && last_with_force_ != 0 &&
                           !wire::isNewer(state.reflected, last_with_force_);
    states_without_force_ = has_force ? 0 : states_without_force_ + 1;
    if (state.force < kFelt) return;
    if (off_states_ >= kStatesUntilGone) complain("given by motors that are off", state.force);
    if (states_without_force_ >= kStatesUntilGone)
        complain("given by motors that were told none", state.force);
}

void ForceWatch::complain(const std::string& what, double force) {
    if (complaint_.empty()) complaint_ = std::to_string(force) + " N: " + what;
}

}  // namespace bonemill::test

// Judges what passes on the wire between device_daemon and the motors: no force is ordered, and none given,
// while the hand is not engaged, but for the ramp that leads out of it (docs/explanation/safety.md).
//
// It is for one thread.
#pragma once

#include <span>
#include <string>

#include "tests/integration/device/tapped_wire.h"

namespace bonemill::test {

class ForceWatch {
  public:
    // `ramp` is the scene's loop.ramp_ms, s.
    explicit ForceWatch(double ramp = 0.05) : ramp_(ramp) {}

    // Takes what has passed since the last call.
    void look(std::span<const WirePacket> packets);

    // Of the newest packets.
    bool isEngaged() const { return is_engaged_; }
    double orderedForce() const { return ordered_; }  // N, norm over the motors
    // In a row, of a drive that obeys; since the hand was let go.
    int onStates() const { return on_states_; }

    // How often the hand was engaged, how often it was let go under force, and how often it was engaged
    // without the switch having been pressed since it was engaged before.
    int engagements() const { return engagements_; }
    int ramps() const { return ramps_; }
    int unaskedEngagements() const { return unasked_engagements_; }

    // Says what was wrong first; empty if nothing was.
    const std::string& complaint() const { return complaint_; }

  private:
    void lookAt(const WirePacket& packet);
    void lookAtCommand(const WirePacket& command);
    void lookAtState(const WirePacket& state);
    void complain(const std::string& what, double force);

    double ramp_;
    std::string complaint_;
    int engagements_ = 0, ramps_ = 0, unasked_engagements_ = 0;

    uint32_t session_ = 0;  // of the newest command
    bool is_engaged_ = false;
    double ordered_ = 0;            // N, by the newest command
    double largest_ = 0;            // N, ordered in this engagement
    int64_t newest_ns_ = 0;         // of the newest command, in the daemon's time
    int64_t left_ns_ = 0;           // the first command after it, in the daemon's time
    uint32_t last_with_force_ = 0;  // sequence of the newest command that ordered any
    int states_without_force_ = 0;  // in a row, that answer a command without force
    int on_states_ = 0, off_states_ = 0;
    bool was_held_ = true, is_pressed_ = false;  // the switch; since the last engagement
};

}  // namespace bonemill::test

// A scripted hand that has done all of its script rests. Then clients may have it begin anew, or a viewer's
// mouse may take its place (docs/howto/mouse.md). Whoever takes over is remembered, until another scene.
//
// The hand says itself, with its samples, that its script has ended; what is ordered of it goes to
// device_daemon. All members belong to the publisher thread.
#pragma once

#include <functional>
#include <string>

#include "common/commands/answer.h"
#include "common/device_messages/device_messages.h"
#include "haptic_server/server/session/tick_recorder.h"
#include "proto/topics.pb.h"

namespace bonemill {

class ScriptedHand {
  public:
    // The recorder must outlive this object. `tell_device` is told which hand is wanted.
    ScriptedHand(const Recorder& recorder, std::function<void(HandChoice)> tell_device)
        : recorder_(recorder), tell_device_(std::move(tell_device)) {}

    // Empty if the script may begin anew: it has ended, or another hand has taken over.
    std::string whyNotAgain() const;
    // The hand draws back to where its script starts, and does it anew; who has taken over is the hand no
    // more.
    void beginAnew();
    // The mouse of viewers comes to be the hand, as `sender` has asked; it is refused unless the script has
    // ended.
    Answer takeOver(uint64_t sender);
    // Fills in how the hand stands; nothing where there is none, or it is under way.
    void describe(topics::Device& device) const;

  private:
    bool hasEnded() const;

    const Recorder& recorder_;
    std::function<void(HandChoice)> tell_device_;
    uint64_t taken_over_by_ = 0;
};

}  // namespace bonemill

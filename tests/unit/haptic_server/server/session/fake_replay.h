// A replay that notes what it is ordered.
#pragma once

#include <string>

#include "haptic_server/server/session/session_commands.h"

namespace bonemill::test {

class FakeReplay final : public ReplayOrders {
  public:
    void play(bool goes_on) override { said_ += goes_on ? "play " : "hold "; }
    Answer carryOut(const topics::ReplayOrder& order) override {
        said_ += "seek " + std::to_string(int(order.seek_s())) + " ";
        return Answer::done();
    }
    void describe(topics::Replay& replay) const override { replay.set_length_s(60); }
    void extend(topics::SceneInfo&) override {}
    std::optional<Pose> otherTool() const override { return std::nullopt; }

    std::string said_;
};

}  // namespace bonemill::test

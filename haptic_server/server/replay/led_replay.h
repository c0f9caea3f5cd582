// All that viewers may order of a replay: the player leads it, and another attempt is compared with it.
#pragma once

#include "haptic_server/server/replay/comparison.h"
#include "haptic_server/server/replay/player.h"
#include "haptic_server/server/session/session_commands.h"

namespace bonemill {

class LedReplay final : public ReplayOrders {
  public:
    // Both must outlive this object.
    LedReplay(Player& player, Comparison& comparison) : player_(player), comparison_(comparison) {}

    void play(bool goes_on) override { player_.play(goes_on); }
    Answer carryOut(const topics::ReplayOrder& order) override {
        if (order.has_shows_difference()) return comparison_.showDifference(order.shows_difference());
        if (order.has_shows_beside()) return comparison_.showBeside(order.shows_beside());
        if (!order.has_compare_with()) return player_.carryOut(order);
        return order.compare_with().empty() ? comparison_.compareWithNone()
                                            : comparison_.compareWithResult(order.compare_with());
    }
    void describe(topics::Replay& replay) const override {
        player_.describe(replay);
        comparison_.describe(replay);
    }
    void extend(topics::SceneInfo& info) override { comparison_.extend(info); }
    std::optional<Pose> otherTool() const override { return comparison_.otherTool(); }

  private:
    Player& player_;
    Comparison& comparison_;
};

}  // namespace bonemill

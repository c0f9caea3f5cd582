// These are the lines, alerts and figures of training that tell of a scene's effects, and how its task
// stands. The functions are pure; any thread may call them.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/look/hud/hud.h"

namespace bonemill {

// Both return only what the scene's effects say: how careful the trainee is, and what the motor does.
// `events` are the EffectState.Event bits that are shown now; `info` has the names of materials.
std::vector<HudRow> effectTaskRows(const topics::EffectState& state, const topics::SceneInfo* info,
                                   uint32_t events);
std::vector<HudRow> effectDetailRows(const topics::EffectState& state);

// Returns what must not be overseen: protected structures and heat. `structure` is
// numbered as EffectState.event_id.
std::optional<HudNotice> effectAlert(uint32_t events, uint32_t structure, const topics::SceneInfo* info);

// Returns how careful the session was so far; the warnings come last.
std::vector<HudRow> trainingRows(const topics::Training& training);

// Returns a name such as "facial nerve", or the number of what has no name.
std::string structureName(uint32_t protected_id, const topics::SceneInfo* info);

// Events that last a tick stay on the screen long enough to be seen.
class EventLatch {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kShown{500};

    void note(uint32_t events) { pending_ |= events; }

    // Returns the events for a picture drawn at `now`: what was noted since the picture before, and what was
    // shown first less than kShown ago.
    uint32_t show(Clock::time_point now) {
        uint32_t shown = 0;
        for (size_t bit = 0; bit < until_.size(); ++bit) {
            if (pending_ >> bit & 1) until_[bit] = now + kShown;
            if (until_[bit] > now) shown |= 1u << bit;
        }
        pending_ = 0;
        return shown;
    }

  private:
    uint32_t pending_ = 0;
    std::array<Clock::time_point, 32> until_{};
};

// How the scene's task stands, or what the last attempt came to: the time that is left, each kind of zone in
// one line, and one on the gates; a result names those that are broken, the first few of them.
std::vector<HudRow> taskStateRows(const topics::TaskState& task);
// All of it in one line, where there is no room for more.
HudRow taskSummaryRow(const topics::TaskState& task);

}  // namespace bonemill

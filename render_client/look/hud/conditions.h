// Says in words what stands in the way of the session now, and what to do. The functions are pure; any thread
// may call them.
#pragma once

#include <string>
#include <vector>

#include "render_client/look/hud/hud_lines.h"

namespace bonemill {

struct Condition {
    std::string id;    // the same while it lasts, whatever its words
    std::string text;  // UTF-8, a sentence or two; a plain fault is listed, but not said
    HudTone tone = HudTone::kPlain;
    bool is_fault = false;  // it stays in the list of faults
    bool lasts = true;      // false: it has happened since the server began, how often is unknown
};

// The worst comes first.
std::vector<Condition> conditionsOf(const HudInput& input);

}  // namespace bonemill

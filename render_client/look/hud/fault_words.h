// Puts the faults that the server names into words. The function is pure; any thread may call it.
#pragma once

#include <string>
#include <vector>

#include "render_client/look/hud/hud.h"

namespace bonemill {

struct FaultWords {
    std::string name;  // the server's
    std::string text;
    HudTone tone = HudTone::kWarning;  // plain: a limit did what it is for
};

// Takes Status.fault_text, names with commas between them; of a name that this version does not know the text
// is the name. Repeated names count once.
std::vector<FaultWords> faultWords(const std::string& names);

}  // namespace bonemill

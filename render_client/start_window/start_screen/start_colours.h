// What colours mean in the window to begin in. For the sources of this room.
#pragma once

#include <imgui.h>

namespace bonemill {

inline const ImVec4 kGood{0.45f, 0.85f, 0.5f, 1}, kOpen{1.00f, 0.80f, 0.35f, 1},
    kFailed{1.00f, 0.42f, 0.36f, 1}, kAside{0.62f, 0.68f, 0.74f, 1}, kHeading{0.55f, 0.78f, 1, 1};

}  // namespace bonemill

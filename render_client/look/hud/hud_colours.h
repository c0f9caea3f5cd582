// The colours of figures and panel are red, green, blue and opacity, each from 0 to 1. They are plain values,
// for any thread.
#pragma once

#include <array>

#include "render_client/look/hud/hud.h"

namespace bonemill {

using HudColour = std::array<float, 4>;

inline constexpr HudColour kHudPanelColour{0.03f, 0.045f, 0.06f, 0.74f};
inline constexpr HudColour kHudLabelColour{0.62f, 0.68f, 0.74f, 1};
inline constexpr HudColour kHudTitleColour{1, 1, 1, 1};
inline constexpr HudColour kHudHeadingColour{0.55f, 0.78f, 1, 1};
inline constexpr HudColour kHudLineColour{1, 1, 1, 0.14f};
inline constexpr HudColour kHudScaleColour{0.92f, 0.94f, 0.96f, 0.9f};
inline constexpr HudColour kHudPointerNameColour{1, 0.62f, 0.88f, 1};

HudColour colourOf(HudTone tone);

}  // namespace bonemill

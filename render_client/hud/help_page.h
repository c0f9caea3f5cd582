// The help page over the picture. It has as many columns as the picture's height needs, in smaller text where
// they are too wide. Pure functions, any thread.
#pragma once

#include <vector>

#include "render_client/hud/hud_layout.h"

namespace bonemill {

// Returns the height (pixels) of the font that the page needs: that of `font`, or less.
float helpTextHeight(const FontAtlas& font, const std::vector<HudRow>& rows, const PictureSize& picture);

// The page stands in the middle of the picture.
void layOutHelp(HudCanvas& canvas, const std::vector<HudRow>& rows, const PictureSize& picture);

}  // namespace bonemill

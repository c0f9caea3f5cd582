// The help page lies over the picture. It has as many columns as the picture's height needs, in smaller text
// where they are too wide; a group of keys stays in one column if it can. The functions are pure; any thread
// may call them.
#pragma once

#include <vector>

#include "render_client/look/hud/hud_layout.h"

namespace bonemill {

// Returns the groups without the last ones for which the picture is too small even in the smallest text.
std::vector<HelpGroup> helpThatFits(const FontAtlas& font, std::vector<HelpGroup> groups,
                                    const PictureSize& picture);

// Returns the height (pixels) of the font that the page needs: that of `font`, or less.
float helpTextHeight(const FontAtlas& font, const std::vector<HelpGroup>& groups, const PictureSize& picture);

// The page stands in the middle of the picture.
void layOutHelp(HudCanvas& canvas, const std::vector<HelpGroup>& groups, const PictureSize& picture);

}  // namespace bonemill

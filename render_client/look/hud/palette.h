// The colours (sRGB, 0 to 1) by which figures, panel and picture tell things apart, as usual or so that
// people who see colours differently can tell them, too.
//
// Those for colour-blind people began as those of Okabe and Ito ("Color Universal Design", 2008), and were
// moved apart until any two of a row differ by 30 or more (CIE 1976, L*a*b*) to usual eyes and to those
// without one of the three kinds of cones (Machado et al., "A Physiologically-based Model for Simulation of
// Color Vision Deficiency", 2009). The choice belongs to the render thread.
#pragma once

#include <array>

#include "common/config/shown_colours.h"

namespace bonemill {

struct Palette {
    std::array<Srgb, 4> tones;        // by HudTone
    std::array<Srgb, 4> named;        // structures: nerve, vein, artery, dura
    std::array<Srgb, 6> structures;   // those whose name says nothing
    std::array<Srgb, 3> distance;     // of the burr to a structure: none, half, as the warning
    std::array<Srgb, 6> zones;        // of a task, as kZoneColours, and any other
    std::array<Srgb, 3> differences;  // as kDifferenceColours
};
const Palette& usualPalette();
const Palette& colourBlindPalette();

// All that is drawn from now on has the colours of this one.
void usePalette(bool is_for_colour_blind);
const Palette& palette();

// Returns the palette's colour in place of one that the server gives where a scene names none; a scene's own
// colours stay.
scene::Color shownColour(const scene::Color& colour);

}  // namespace bonemill

// Signs over the picture: which way the patient lies, what a pane with a slice shows, and the help page. The
// functions are pure; any thread may call them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "render_client/look/hud/hud.h"
#include "render_client/look/hud/hud_canvas.h"
#include "render_client/look/hud/hud_layout.h"

namespace bonemill {

// An end of an axis as it is drawn: towards (right, up) of unit length or less; `nearness` is 1 when it
// points at the eye, -1 away from it.
struct OrientationEnd {
    char letter;
    int axis;
    bool is_positive;
    Eigen::Vector2f towards;
    float nearness;
};

// Returns the ends that have a letter, the farthest first: R, L, A, P, S, I of the patient, or x, y, z.
std::vector<OrientationEnd> orientationEnds(const OrientationAxes& axes);

// Puts a small marker that turns with the camera into the picture's lower right corner, above the scale bar's
// place: it says where the patient's sides are, or at least the volume's axes. A picture that is too small
// for it gets none.
void layOutOrientation(HudCanvas& canvas, const OrientationAxes& axes, const PictureSize& picture);

// What is written on a pane with a slice through the scan. Positions and sizes are pixels from the picture's
// upper left corner.
struct HudPane {
    float x = 0, y = 0, width = 0, height = 0;
    std::string title;                     // "Axial"
    std::string left, right, top, bottom;  // what of the patient lies beyond that edge
    std::string window, place;             // below: "W 2000 L 800", "z 12.4 mm"
    bool is_scrolled = false;              // it does not follow the burr
    std::string problem;                   // why nothing can be seen; empty: something can
};

// The title stands upper left, the letters in the middles of the edges, the window lower left and the place
// lower right; what does not fit is cut short.
void layOutPane(HudCanvas& canvas, const HudPane& pane);

// The help page lies over the picture. It has as many columns as the picture's height needs, in smaller text
// where they are too wide; a group of keys stays in one column if it can.
//
// Returns the groups without the last ones for which the picture is too small even in the smallest text.
std::vector<HelpGroup> helpThatFits(const FontAtlas& font, std::vector<HelpGroup> groups,
                                    const PictureSize& picture);

// Returns the height (pixels) of the font that the page needs: that of `font`, or less.
float helpTextHeight(const FontAtlas& font, const std::vector<HelpGroup>& groups, const PictureSize& picture);

// The page stands in the middle of the picture.
void layOutHelp(HudCanvas& canvas, const std::vector<HelpGroup>& groups, const PictureSize& picture);

}  // namespace bonemill

// Decides where the parts of the head-up display stand in a picture, and how they look. The functions are
// pure; any thread may call them.
//
// Positions and sizes are pixels from the picture's upper left corner.
#pragma once

#include <string>
#include <vector>

#include "render_client/look/hud/hud.h"
#include "render_client/look/hud/hud_canvas.h"

namespace bonemill {

// Beside a bar of a round length one sees how large the bone is.
struct ScaleBar {
    double length = 0;  // m; 0: there is none
    std::string label;
};

// Returns the longest length of 1, 2 or 5 times a power of ten that spans at most max_pixels.
ScaleBar makeScaleBar(double metres_per_pixel, double max_pixels);

struct PictureSize {
    int width = 0;
    int height = 0;
};

// What a list takes of the picture.
struct HudBox {
    float left, top, right, bottom;
};

// Puts the figures that matter to the task into the upper left corner. The box is always of the same width:
// what does not fit is cut short.
HudBox layOutFigures(HudCanvas& canvas, const Hud& hud);
// Puts the other figures below those of the task, as wide as they are; the canvas may have a smaller font.
// Returns what both take.
HudBox layOutDetails(HudCanvas& canvas, const std::vector<HudRow>& details, const HudBox& figures);

// Puts the list of watchers at the upper right, or below the figures when there is no room beside them.
// One below the other, under the figures.
void layOutModes(HudCanvas& canvas, const std::vector<std::string>& modes, const HudBox& figures);
void layOutWatchers(HudCanvas& canvas, const std::vector<HudRow>& watchers, const HudBox& figures,
                    const PictureSize& picture);

// Puts the scale bar into the lower right corner.
void layOutScaleBar(HudCanvas& canvas, const ScaleBar& bar, double metres_per_pixel,
                    const PictureSize& picture);

// Puts the legend above the scale bar.
void layOutLegend(HudCanvas& canvas, const HudLegend& legend, const PictureSize& picture);

// Puts the page into the middle of the picture.
void layOutPage(HudCanvas& canvas, const HudPage& page, const PictureSize& picture);

// Puts the hint into the lower left corner, or beside the figures when there is no room below them.
void layOutHint(HudCanvas& canvas, const HudHint& hint, const HudBox& figures, const PictureSize& picture);

// A notice is a line in the middle of the lower edge. An alert is a line above it, with a border around the
// picture: neither hides the other.
void layOutNotice(HudCanvas& canvas, const HudNotice& notice, const PictureSize& picture);
void layOutAlert(HudCanvas& canvas, const HudNotice& alert, const PictureSize& picture);
// Puts the messages above both, the first one on top.
void layOutMessages(HudCanvas& canvas, const std::vector<HudNotice>& messages, const PictureSize& picture);

// Puts a name beside its point.
void layOutLabel(HudCanvas& canvas, const HudLabel& label);

}  // namespace bonemill

// Writes on a pane with a slice through the scan. The function is pure; any thread may call it.
#pragma once

#include <string>

#include "render_client/look/hud/hud_canvas.h"

namespace bonemill {

// Positions and sizes are pixels from the picture's upper left corner.
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

}  // namespace bonemill

// A scripted hand has ended: what may come next, as a window of ImGui with two buttons over the picture. It
// belongs to the render thread.
#pragma once

#include <map>
#include <string>

#include "render_client/hand/controls/viewer_controls.h"

namespace bonemill {

// The hand has ended, and this viewer may say what comes next.
bool isHandCardOnScreen(const SessionView& session);

// It is called between ImGui::NewFrame() and ImGui::Render(), while the card is on the screen. `places` takes
// where each button is, by its label; the card stands low in the middle of what the panel leaves of the
// view: this width (pixels).
void buildHandCard(ViewerControls& controls, const SessionView& session, Wishes& wishes,
                   std::map<std::string, PixelPoint>& places, float scale, float view_width);

}  // namespace bonemill

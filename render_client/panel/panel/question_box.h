// A question to the user in the middle of the picture, as a window of ImGui. It stands until it is answered:
// Enter means yes, Esc no. It belongs to the render thread.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "render_client/hand/controls/viewer_controls.h"

namespace bonemill {

// Is called between ImGui::NewFrame() and ImGui::Render(), last of all windows; draws nothing while no
// question stands. `places` takes where each answer is.
void buildQuestion(ViewerControls& controls, const SessionView& session, Wishes& wishes,
                   std::map<std::string, PixelPoint>& places, float scale, float view_width);

// Returns the answer that a key gives.
std::optional<ViewerControls::Answer> answerOfKey(const WindowEvent& event);

}  // namespace bonemill

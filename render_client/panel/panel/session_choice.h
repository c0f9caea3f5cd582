// Several sessions are there and none was asked for: the user chooses one, as a window of ImGui. It belongs
// to the render thread.
#pragma once

#include <map>
#include <string>

#include "render_client/hand/controls/viewer_controls.h"

namespace bonemill {

// It is called between ImGui::NewFrame() and ImGui::Render(). `places` takes where each control is.
void buildSessionChoice(const SessionView& session, Wishes& wishes, std::map<std::string, PixelPoint>& places,
                        float scale);

// Returns the session that this key chooses, 1 the first that is offered; none if it chooses none.
std::optional<uint32_t> sessionOfKey(const WindowEvent& event, const SessionView& session);

}  // namespace bonemill

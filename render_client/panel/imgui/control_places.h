// Where the controls of a screen are, by their label: tests click there. It belongs to the render thread.
#pragma once

#include <map>
#include <string>

#include "render_client/hand/controls/window_event.h"

namespace bonemill {

using ControlPlaces = std::map<std::string, PixelPoint>;

// Notes the middle of the control that was built last, if it can be seen.
void notePlace(ControlPlaces& places, const std::string& label);

}  // namespace bonemill

// Shows the viewer in a window.
#pragma once

#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

// Runs until the window is closed or a stop signal comes. Throws UserError (no display,
// DDS domain) and GlError.
void runWindow(const ClientOptions& options);

}  // namespace bonemill

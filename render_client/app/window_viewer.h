// The viewer in a window.
#pragma once

#include "render_client/app/options.h"

namespace bonemill {

// Until the window is closed or a stop signal came. Throws UserError (no display, DDS domain) and GlError.
void runWindow(const ClientOptions& options);

}  // namespace bonemill

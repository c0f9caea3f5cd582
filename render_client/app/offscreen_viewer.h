// The viewer without a display: pictures into a folder, one JSON line per picture on stdout.
#pragma once

#include "render_client/app/options.h"

namespace bonemill {

// Until all pictures are written or a stop signal came. Throws UserError (folder, DDS domain), GlError, and
// std::runtime_error when --wait-complete ran out of time.
void runOffscreen(const ClientOptions& options);

}  // namespace bonemill

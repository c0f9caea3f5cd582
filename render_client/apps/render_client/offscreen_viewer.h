// The viewer without a display writes pictures into a folder, and one JSON line per picture to stdout.
#pragma once

#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

// Runs until all pictures are written or a stop signal comes. Throws UserError (folder, DDS domain), GlError,
// and std::runtime_error when --wait-complete ran out of time.
void runOffscreen(const ClientOptions& options);

}  // namespace bonemill

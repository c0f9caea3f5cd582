// render_client --relay: a relay instead of a viewer.
#pragma once

#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

// Says where it can be reached, and serves until a stop signal. Returns the exit code. Throws UserError.
int runRelay(const ClientOptions& options);

}  // namespace bonemill

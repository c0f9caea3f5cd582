// render_client --list: which sessions are there?
#pragma once

#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

// Listens for some seconds and prints one line per session of the domain. Returns the exit code: 1 where
// there is none, which is said. Throws UserError when the DDS domain cannot be joined.
int runListSessions(const ClientOptions& options);

}  // namespace bonemill

// Sends one command for scripts: no picture, one line on stdout.
#pragma once

#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

// Waits for the server, asks it and prints its answer. Returns the program's exit code: 0 if the server did
// it, 1 if it refused or did not answer, or a stop signal came first. Throws UserError (DDS domain, a tool or
// checkpoint that the session does not have), and std::runtime_error when no server came in time.
int runSendCommand(const ClientOptions& options);

}  // namespace bonemill

// Puts a command, and how it ended, into words for logs and people. It is for any thread.
#pragma once

#include <string>

#include "render_client/link/subscribe/command_outbox.h"

namespace bonemill {

// Returns "accuracy balanced", "put the bone back", ...
std::string commandText(const topics::Command& command);

// Returns "accuracy balanced: done", "accuracy best: refused: ...", "shut down: the server did not answer".
std::string outcomeText(const CommandOutcome& outcome);

}  // namespace bonemill

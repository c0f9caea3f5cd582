// A command and how it ended in words, for logs and people. Any thread.
#pragma once

#include <string>

#include "render_client/subscribe/command_outbox.h"

namespace bonemill {

// "accuracy balanced", "put the bone back", ...
std::string commandText(const topics::Command& command);

// "accuracy balanced: done", "accuracy best: refused: ...", "shut down: the server did not answer".
std::string outcomeText(const CommandOutcome& outcome);

}  // namespace bonemill

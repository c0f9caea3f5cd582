// Reads commands as people write them: the words of the rows (common/commands/command_rows.h).
#pragma once

#include <string>
#include <vector>

#include "proto/topics.pb.h"

namespace bonemill {

// Returns every word with what follows it: "reset", "tool NAME-or-number", ...
std::vector<std::string> commandWords();

// Returns why this is no command, as far as can be said without a server; empty when it may be one.
std::string commandProblem(const std::string& text);

// Returns what it means in the session that shows these. Throws UserError for what is no command, and for
// names and checkpoints that this session does not have.
topics::Command commandOf(const std::string& text, const topics::SceneInfo& scene,
                          const topics::Status& status);

}  // namespace bonemill

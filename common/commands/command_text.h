// Puts a command into words for people, as its row says. It is for any thread.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

// Returns "accuracy balanced", "put the bone back", ...
std::string commandText(const topics::Command& command);

// Returns a sentence that what was asked of the server is done. `trainee` says whose attempt has ended; it
// may be empty.
std::string doneText(const topics::Command& command, const std::string& trainee);

}  // namespace bonemill

// Puts a command into words, for people as its row says, and for the log. It is for any thread.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

// Returns "accuracy balanced", "put the bone back", ...
std::string commandText(const topics::Command& command);

// Returns a sentence that what was asked of the server is done. `trainee` says whose attempt has ended; it
// may be empty.
std::string doneText(const topics::Command& command, const std::string& trainee);

// For the log: returns the field and what is in it: "set_accuracy fast", "select_tool 2", "pause_milling
// false".
std::string orderText(const topics::Command& command);

// For the log: returns "Anna (instructor, proven)", or the sender's number where it has no name.
std::string senderText(const topics::Command& command, const std::string& proof);

}  // namespace bonemill

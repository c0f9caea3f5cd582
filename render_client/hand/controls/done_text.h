// Says in a sentence that what the user asked of the server is done. It is for any thread.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

// `lesson` says whose attempt has ended; it may be null.
std::string doneText(const topics::Command& command, const topics::Lesson* lesson);

}  // namespace bonemill

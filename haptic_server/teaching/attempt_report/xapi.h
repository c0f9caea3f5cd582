// An attempt as a statement for learning record stores: xAPI 1.0.3, one JSON object on one line. The actor is
// the pseudonym. The function is pure; any thread may call it.
#pragma once

#include <string>

#include "haptic_server/teaching/attempt_report/attempt_result.h"

namespace bonemill {

// The verb is passed or failed where the task has gates, else completed; a score is there where the teacher
// gave weights. The statement's id is a UUID of whose attempt at what it is and when (version 5), so that the
// same attempt told twice is one.
std::string xapiStatement(const AttemptResult& result);

}  // namespace bonemill

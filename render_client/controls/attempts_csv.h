// Writes how a class' attempts went as text for a spreadsheet. The function is pure; any thread may call it.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

// Returns one line per attempt below a header with units, comma separated, as UTF-8. What is not known stays
// empty. Texts are quoted; one that a spreadsheet would take for a formula stands behind an apostrophe.
std::string attemptsCsv(const topics::Lesson& lesson);

}  // namespace bonemill

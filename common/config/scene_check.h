// Are the values of a parsed scene allowed, each by itself and together?
#pragma once

#include <string>

#include "common/config/scene_text.h"

namespace bonemill {

// Throws UserError "name:line: field `path` = value ..." for the first value that is not finite, outside its
// (range), or in conflict with another field. It is for start-up only.
void checkScene(const ParsedScene& parsed, const std::string& name);

}  // namespace bonemill

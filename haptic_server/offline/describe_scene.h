// What a scene says, for people.
#pragma once

#include <string>

namespace bonemill {

// Every field with value, unit and range; what was read; what runs in each tick and its measured cost here.
// Throws UserError.
std::string describeScene(const std::string& scene_file);

}  // namespace bonemill

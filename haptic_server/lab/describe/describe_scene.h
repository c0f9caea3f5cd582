// Tells people what a scene says.
#pragma once

#include <string>

namespace bonemill {

// Lists every field with value, unit and range, what was read, and what runs in each tick with its measured
// cost here. Throws UserError.
std::string describeScene(const std::string& scene_file);

}  // namespace bonemill

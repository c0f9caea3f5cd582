// Every field of the scene with its unit, default and range, from the schema itself.
#pragma once

#include <string>

namespace bonemill {

// A Markdown table, one row per field, in the order of proto/scene.proto. For --describe-scene and
// docs/scene.md.
std::string describeDefaults();

}  // namespace bonemill

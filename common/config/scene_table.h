// Lists every field of the scene with its unit, default and range, from the schema itself.
#pragma once

#include <string>

namespace bonemill {

// Makes a Markdown table, one row per field, in the order of proto/scene.proto, for
// --describe-scene and docs/reference/scene.md.
std::string describeDefaults();

}  // namespace bonemill

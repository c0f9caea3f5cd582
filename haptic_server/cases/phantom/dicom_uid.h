// Makes unique identifiers for DICOM files.
#pragma once

#include <string>

namespace bonemill {

// Makes a valid UID under 2.25 (UUID-derived) from any text: the same text gives the same UID.
std::string uidFromText(const std::string& text);

}  // namespace bonemill

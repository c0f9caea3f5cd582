// Reads the decimal numbers of a DICOM text (VR DS, "0.5\0.5"), which libraries read as 0 or as 1 where there
// is no number.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bonemill {

// Nothing when any of them is no finite number.
std::optional<std::vector<double>> decimalNumbers(const std::string& text);

// DICOM pads texts with blanks on both sides and with a zero byte at the end.
std::string withoutPadding(const std::string& text);

}  // namespace bonemill

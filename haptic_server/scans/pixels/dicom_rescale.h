// The decimal numbers of a DICOM text (VR DS, "0.5\0.5"), which libraries read as 0 or as 1 where there is no
// number; and how stored values become what they mean (HU for CT): slope * stored + intercept.
//
// There is no Eigen in here: ITK's sources include it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bonemill {

struct DicomRescale {
    double slope = 1;
    double intercept = 0;
    bool operator==(const DicomRescale&) const = default;
};

// Of the texts of Rescale Slope and Intercept; nothing when both are empty. Throws UserError naming `image`
// when one of them is missing or no number, or the slope is 0.
std::optional<DicomRescale> rescaleFromTexts(const std::string& slope, const std::string& intercept,
                                             const std::string& image);

// Nothing when any of them is no finite number.
std::optional<std::vector<double>> decimalNumbers(const std::string& text);

// DICOM pads texts with blanks on both sides and with a zero byte at the end.
std::string withoutPadding(const std::string& text);

}  // namespace bonemill

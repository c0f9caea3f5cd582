// Reads where a DICOM image lies from the texts of its header. GDCM takes 1 mm, the patient's axes or the
// origin where it cannot read them, or does not like what it reads.
#pragma once

#include <Eigen/Core>
#include <string>

namespace bonemill {

// Lengths are in mm, in LPS.
struct DicomPlace {
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  // centre of the first pixel
    Eigen::Vector3d row_direction = Eigen::Vector3d::UnitX();
    Eigen::Vector3d column_direction = Eigen::Vector3d::UnitY();
    Eigen::Vector2d pixel_spacing_mm = Eigen::Vector2d::Ones();  // along the row, along the column
    double rounding = 0;  // how far the file's axes are from unit vectors, or their cosine from 0
};

struct DicomPlaceTexts {
    std::string position;       // Image Position (Patient) (0020,0032)
    std::string orientation;    // Image Orientation (Patient) (0020,0037)
    std::string pixel_spacing;  // Pixel Spacing (0028,0030)

    bool areComplete() const { return !position.empty() && !orientation.empty() && !pixel_spacing.empty(); }
};

// So far a number of the orientation may be from what is meant.
inline constexpr double kTwoDigits = 0.005;
inline constexpr double kThreeDigits = 0.0005;

// The axes are made perpendicular unit vectors when the rounding of their numbers explains that they are not.
// Throws UserError naming `image` when it does not, when a text is not the numbers that it should be, or a
// spacing is not above 0.
DicomPlace placeFromTexts(const DicomPlaceTexts& texts, double most_rounding, const std::string& image);

}  // namespace bonemill

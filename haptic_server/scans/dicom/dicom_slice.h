// One picture of a DICOM file, as its header describes it, and where it lies, from the header's texts: GDCM
// takes 1 mm, the patient's axes or the origin where it cannot read them, or does not like what it reads.
// Positions and spacings are in mm and LPS, as in the files. There is no DICOM library in here.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "haptic_server/scans/pixels/dicom_rescale.h"

namespace bonemill {

struct DicomPlace {
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();     // centre of the first pixel
    Eigen::Vector3d row_direction = Eigen::Vector3d::UnitX();  // along increasing column index
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

// What tells the pictures of one series apart that show the same place: several acquisitions, phases,
// weightings or reconstructions. As the headers say, without padding; empty: nothing.
struct DicomTraits {
    std::string acquisition_number;  // (0020,0012), of frames (0020,9156)
    std::string temporal_position;   // (0020,0100), of frames (0020,9128)
    std::string b_value;             // (0018,9087)
    std::string kernel;              // (0018,1210)
    std::string image_type;          // (0008,0008), of frames (0008,9007): ORIGINAL\PRIMARY\AXIAL
    std::string acquisition_time;    // (0008,0032)
    std::string content_time;        // (0008,0033)
};

struct DicomSlice : DicomPlace {
    std::filesystem::path path;
    std::string series_uid;
    std::string series_description;
    std::string modality, contrast;  // as the header says; empty: nothing
    std::string patient;             // Patient ID and Patient's Name
    std::string space_uid;           // Frame of Reference: where the origin of all positions lies
    DicomTraits traits;
    std::optional<DicomRescale> rescale;  // nothing: the file does not say it
    int columns = 0;
    int rows = 0;
    int frame = 0;  // which image of the file
    bool isCt() const { return modality == "CT"; }

    Eigen::Vector3d normal() const { return row_direction.cross(column_direction); }
    Eigen::Vector3d middle_mm() const {
        return position_mm + (columns - 1) / 2.0 * pixel_spacing_mm.x() * row_direction +
               (rows - 1) / 2.0 * pixel_spacing_mm.y() * column_direction;
    }
};

// A file that cannot be read: a series may miss its pictures.
struct DamagedFile {
    std::filesystem::path path;
    std::string problem;     // for people: names the file
    std::string series_uid;  // empty: it is not known, and may be any
};

// Do two slices at the same place hold the same picture?
using IsSamePicture = std::function<bool(const DicomSlice&, const DicomSlice&)>;

}  // namespace bonemill

// One picture of a DICOM file, as its header describes it. Positions and spacings are in mm and LPS, as in
// the files.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "haptic_server/scans/pixels/dicom_rescale.h"

namespace bonemill {

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

struct DicomSlice {
    std::filesystem::path path;
    std::string series_uid;
    std::string series_description;
    std::string modality, contrast;  // as the header says; empty: nothing
    DicomTraits traits;
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();     // centre of the first pixel
    Eigen::Vector3d row_direction = Eigen::Vector3d::UnitX();  // along increasing column index
    Eigen::Vector3d column_direction = Eigen::Vector3d::UnitY();
    Eigen::Vector2d pixel_spacing_mm = Eigen::Vector2d::Ones();  // along the row, along the column
    double axes_rounding = 0;                                    // of the file's directions (dicom_place.h)
    std::optional<DicomRescale> rescale;                         // nothing: as the library says
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

// Do two slices at the same place hold the same picture?
using IsSamePicture = std::function<bool(const DicomSlice&, const DicomSlice&)>;

}  // namespace bonemill

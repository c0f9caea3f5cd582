// Chooses the files of a folder that make one volume, and their order: from headers, never from file names.
//
// There is no DICOM library in here: tests feed it headers. Positions and spacings are in mm and LPS, as
// in the files.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/volume/import/dicom_rescale.h"
#include "haptic_server/volume/import/uneven_stack.h"

namespace bonemill {

struct DicomSlice {
    std::filesystem::path path;
    std::string series_uid;
    std::string series_description;
    std::string modality, kernel, contrast;                    // as the header says; empty: nothing
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
};

struct DicomStack {
    std::vector<DicomSlice> slices;  // ascending along the normal
    double slice_spacing_mm = 0;
    std::vector<SlicePlace> places;  // of the slices, where they are to be resampled; else empty
    std::string left_out;            // for people: other series in the folder
    std::string remark;              // for people: what was mended, and how far that may be off; else empty
};

// Do two slices at the same place hold the same picture?
using IsSamePicture = std::function<bool(const DicomSlice&, const DicomSlice&)>;

// Slices of one series with the same orientation, size and pixel spacing as the first of them belong
// together. Of the groups (of `series_uid` only, when it is not empty) CT goes before all else, then the one
// with the most slices. Copies of a slice are dropped. Slices that lie as evenly as a scanner rounds, and
// straight above each other, are taken as they are; those of a gantry tilted by up to 45 degrees, or at other
// distances, are to be resampled. Throws UserError, naming `folder` and the files and positions at fault.
DicomStack chooseStack(const std::vector<DicomSlice>& slices, const std::string& series_uid,
                       const std::string& folder, const IsSamePicture& is_same_picture);

}  // namespace bonemill

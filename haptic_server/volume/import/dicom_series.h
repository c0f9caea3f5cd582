// Chooses the files of a folder that make one volume, and their order: from headers, never from file names.
//
// There is no DICOM library in here: tests feed it headers. Positions and spacings are in mm and LPS, as
// in the files.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

namespace bonemill {

struct DicomSlice {
    std::filesystem::path path;
    std::string series_uid;
    std::string series_description;
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();     // centre of the first pixel
    Eigen::Vector3d row_direction = Eigen::Vector3d::UnitX();  // along increasing column index
    Eigen::Vector3d column_direction = Eigen::Vector3d::UnitY();
    Eigen::Vector2d pixel_spacing_mm = Eigen::Vector2d::Ones();  // along the row, along the column
    int columns = 0;
    int rows = 0;
    int frame = 0;  // which image of the file
    bool is_ct = false;

    Eigen::Vector3d normal() const { return row_direction.cross(column_direction); }
};

struct DicomStack {
    std::vector<DicomSlice> slices;  // ascending along the normal
    double slice_spacing_mm = 0;
    std::string left_out;  // for people: other series in the folder
};

// Slices of one series with the same orientation, size and pixel spacing belong together; the group with the
// most slices is taken (of `series_uid` only, when it is not empty). Checks that its slices are evenly spaced
// and not tilted. Throws UserError, naming `folder` and the files and positions at fault.
DicomStack chooseStack(const std::vector<DicomSlice>& slices, const std::string& series_uid,
                       const std::string& folder);

}  // namespace bonemill

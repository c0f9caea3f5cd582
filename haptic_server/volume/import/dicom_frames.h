// Finds where each frame of a multi-frame DICOM file lies: ITK tells one place for all of them.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace bonemill {

// Lengths are in mm, in LPS.
struct DicomFrame {
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  // centre of the first pixel
    Eigen::Vector3d row_direction = Eigen::Vector3d::Zero();
    Eigen::Vector3d column_direction = Eigen::Vector3d::Zero();
    Eigen::Vector2d pixel_spacing_mm = Eigen::Vector2d::Zero();  // along the row, along the column
};

// There is one of every frame, from the functional groups of an enhanced image (per frame, else shared), and
// none when the file does not say all of it for each frame.
std::vector<DicomFrame> readFrames(const std::filesystem::path& path);

}  // namespace bonemill

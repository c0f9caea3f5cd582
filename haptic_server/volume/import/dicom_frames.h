// Where each frame of a multi-frame DICOM file lies: ITK tells one place for all of them.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace bonemill {

// mm, LPS.
struct DicomFrame {
    Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  // centre of the first pixel
    Eigen::Vector3d row_direction = Eigen::Vector3d::Zero();
    Eigen::Vector3d column_direction = Eigen::Vector3d::Zero();
    Eigen::Vector2d pixel_spacing_mm = Eigen::Vector2d::Zero();  // along the row, along the column
};

// Of every frame, from the functional groups of an enhanced image (per frame, else shared); empty when the
// file does not say all of it for each frame.
std::vector<DicomFrame> readFrames(const std::filesystem::path& path);

}  // namespace bonemill

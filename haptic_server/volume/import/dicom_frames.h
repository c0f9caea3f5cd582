// Where each frame of a multi-frame DICOM file lies: ITK tells the first one only.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace bonemill {

// Image Position (Patient) of every frame in mm, LPS, from the Per-frame Functional Groups; fewer than frames, or
// none, when the file does not say.
std::vector<Eigen::Vector3d> framePositions(const std::filesystem::path& path);

}  // namespace bonemill

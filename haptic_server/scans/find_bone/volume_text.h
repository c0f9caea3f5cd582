// Volumes in what people read.
#pragma once

#include <Eigen/Core>
#include <string>

namespace bonemill {

// m³ as mm^3: three digits, or all that are before the point.
std::string volumeText(double cubic_metres);

// Edges as "0.957 x 0.957 x 1.5", numbers of voxels as "256 x 256 x 108".
std::string edgesText(const Eigen::Vector3d& edges);

}  // namespace bonemill

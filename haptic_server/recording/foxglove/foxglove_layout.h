// A layout for Foxglove in which an exported session is seen at once. For normal threads.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace bonemill {

// Of the file's topics; the camera looks at `center` (W, m) of what is so large (m). Throws UserError where
// the file cannot be written.
void writeFoxgloveLayout(const std::string& path, const std::vector<std::string>& topics,
                         const Eigen::Vector3d& center, double size);

}  // namespace bonemill

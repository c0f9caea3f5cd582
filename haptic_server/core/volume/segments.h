// The names that a label map gives to its labels, such as those of 3D Slicer's .seg.nrrd files.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bonemill {

struct Segment {
    std::string name;                      // isSegmentName()
    std::optional<Eigen::Vector3d> color;  // red, green, blue, 0 .. 1
    std::vector<uint32_t> labels;          // voxels with these values belong to it; ascending
};

struct Segments {
    std::vector<Segment> list;
    // Voxels were of several segments at once: their values number the combinations and are not the file's.
    bool are_layered = false;
};

inline constexpr size_t kMaxSegments = 256;
inline constexpr size_t kLongestSegmentName = 64;  // bytes

}  // namespace bonemill

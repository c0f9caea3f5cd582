// Turns what a file says about its axes into a VolumeGeometry with a proper rotation.
#pragma once

#include <string>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Files state it so: column a of `directions` is where index axis a points in LPS.
struct FileFrame {
    Eigen::Vector3i dims;
    Eigen::Vector3d spacing_mm;
    Eigen::Matrix3d directions;
    Eigen::Vector3d origin_mm;  // centre of voxel (0, 0, 0)
};

struct FilePlace {
    FileFrame frame;
    bool is_patients = false;  // the file says how the patient lay; else its axes are taken for LPS
};

// Axes may be this far (cosine between two of them) from perpendicular; text headers round to 4-6 digits.
inline constexpr double kMaxAxisCosine = 1e-3;

// Throws UserError naming `file` for sheared, degenerate or non-finite axes.
void checkFrame(const FileFrame& frame, const std::string& file);

// Makes the right-handed geometry of the same voxels. A left-handed file gets its last axis
// reversed, in `values` too (returns true then). Throws UserError naming `file` for sheared,
// degenerate or non-finite axes.
bool makeRightHanded(const FileFrame& frame, const std::string& file, VolumeGeometry& geometry,
                     RawValues& values);

// Throws UserError naming `file` unless its header says the voxels' size or the scene gives it, and not both.
// `fields` are those of the header that would say it.
void requireOneSpacing(bool is_said, bool is_given, const std::string& fields, const std::string& file);

// Reverses the order of the samples along one index axis.
void reverseAxis(RawValues& values, const Eigen::Vector3i& dims, int axis);

}  // namespace bonemill

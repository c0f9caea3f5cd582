// This is a scanned volume as it came from the file: the values, and where they lie in the patient.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "common/geometry/pose.h"
#include "haptic_server/core/volume/raw_values.h"
#include "haptic_server/core/volume/segments.h"

namespace bonemill {

// Voxel (i, j, k) has its centre at X_WV * (spacing ∘ (i, j, k)). W is the file's physical frame (DICOM/LPS),
// in m.
struct VolumeGeometry {
    Eigen::Vector3i dims = Eigen::Vector3i::Zero();     // voxels per axis
    Eigen::Vector3d spacing = Eigen::Vector3d::Ones();  // m per voxel step
    Pose X_WV;  // proper rotation: left-handed files are flipped at import

    size_t voxelCount() const noexcept { return size_t(dims.x()) * size_t(dims.y()) * size_t(dims.z()); }
};

struct RawVolume {
    VolumeGeometry geometry;
    RawValues values;            // x fastest; HU for calibrated CT; may hold NaN
    std::string description;     // for people: format, series, what was repaired
    bool is_hounsfield = false;  // values are calibrated HU (CT with rescale, air near -1000)
    bool lacks_patient_axes =
        false;  // the file does not say how the patient lay: W is LPS by assumption only
    std::optional<double> surface_value = {};  // the values were made of a surface, which has this one
    Segments segments = {};                    // of a label map whose file names them
};

}  // namespace bonemill

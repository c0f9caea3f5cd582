// Makes a regular grid of parallel slices that lie unevenly along their normal, or aside of each other
// because the gantry was tilted. What lies between two slices is taken from the pixels of both, by
// their distances.
//
// Units are mm. It is for start-up only.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "haptic_server/core/volume/raw_values.h"

namespace bonemill {

// Where a slice's first pixel lies, from the first slice's on.
struct SlicePlace {
    double along_mm = 0;                                 // along the normal
    Eigen::Vector2d aside_mm = Eigen::Vector2d::Zero();  // along the row, along the column
};

struct SliceGrid {
    Eigen::Vector3i dims;
    Eigen::Vector3d spacing_mm;
    Eigen::Vector2d aside_mm;  // of its first voxel
};

// The grid holds all pixels of all slices; the places ascend. Its slices are `slice_spacing_mm` apart, from
// the first one on; the last of them may lie beyond the last slice, and repeats it.
SliceGrid gridAround(const std::vector<SlicePlace>& places, const Eigen::Vector2i& size,
                     const Eigen::Vector2d& pixel_spacing_mm, double slice_spacing_mm);

// `values` holds the slices one after the other, each of this size. Beside the slices the lowest value
// stands. Whole numbers stay whole.
RawValues resampleStack(const RawValues& values, const std::vector<SlicePlace>& places,
                        const Eigen::Vector2i& size, const SliceGrid& grid);

}  // namespace bonemill

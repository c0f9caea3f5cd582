// Judges what an attempt has left of the bone: every figure of the final product that the task asks for or
// that its zones and structures allow (docs/reference/tasks.md). The same bone gives the same figures.
//
// It takes one normal thread a second or two with a CT head and allocates some 250 MB at most; no volume may
// be written meanwhile.
#pragma once

#include <optional>

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/product/deviation.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

struct ProductInput {
    const VoxelVolume& scanned;
    const VoxelVolume& now;
    const JudgedTask& task;
    std::optional<double> breach = {};  // m, of a BreachMeter; none where the tool's way is not known
};

struct Product {
    Figures figures;
    DeviationPicture picture;
    std::vector<std::string> left_out;  // what was not measured and why, for people
};

Product measureProduct(const ProductInput& input);

}  // namespace bonemill

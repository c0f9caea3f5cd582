// Finds the material that a scanned voxel is of: by its raw value or by its label.
//
// It is not RT-safe (it allocates) and has no shared state.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "haptic_server/core/volume/material_properties.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// A voxel is of the material if its raw value lies in the range or its label is one of these.
struct MaterialRule {
    bool has_range = false;
    std::optional<double> from = {}, below = {};  // raw values: included, not included; absent: no end
    std::vector<uint32_t> labels = {};            // 0 .. kMaxLabel
};
inline constexpr uint32_t kMaxLabel = 65535;

// There is one of each voxel, x fastest; of several rules that fit the last one wins. Values that are not
// finite fit no range. `of_labels` are those that voxels have by their labels (resample_labels.h), or none.
std::vector<MaterialId> materialIds(const RawVolume& raw, std::span<const MaterialRule> rules,
                                    std::vector<MaterialId> of_labels = {});

}  // namespace bonemill

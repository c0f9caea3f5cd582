// How much there is from any place near the structures to the next of them, in samples on a grid: bone that
// is looked at takes its colour from here. It is a plain value.
#pragma once

#include <vector>

#include "render_client/look/structures/structure_set.h"

namespace bonemill {

struct ThicknessField {
    static constexpr int kMaxSamples = 1 << 19, kMaxPerAxis = 256;

    Eigen::Vector3f first_V = Eigen::Vector3f::Zero();  // m, of the first sample
    float step = 0;                                     // m
    Eigen::Vector3i size = Eigen::Vector3i::Zero();     // samples; 0: nothing is near
    float reach = 0;                                    // m
    std::vector<uint8_t> shares;  // of the reach, x fastest; 255: it is as far or farther
};

// Samples lie at least 0.4 mm apart, and there are kMaxSamples at most, however large the structures are.
// Only those near a structure are computed one by one. It takes tenths of a second.
ThicknessField thicknessField(const StructureSet& structures, double reach);

}  // namespace bonemill

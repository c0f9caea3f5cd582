// How far it is from any place near the structures to the next of them, and that one's colour, in samples on
// a grid: bone takes its looks from here (thickness over structures; what shines through thin bone).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "render_client/look/structures/structure_set.h"

namespace bonemill {

// It is a plain value, in V.
struct NearStructures {
    static constexpr int kMaxSamples = 1 << 19, kMaxPerAxis = 256;

    Eigen::Vector3f first_V = Eigen::Vector3f::Zero();  // m, of the first sample
    float step = 0;                                     // m
    Eigen::Vector3i size = Eigen::Vector3i::Zero();     // samples; 0: nothing is near
    float reach = 0;                                    // m
    // Per sample, x fastest: the linear colour of the nearest structure, and its distance as a share of the
    // reach; 255: it is as far or farther.
    std::vector<std::array<uint8_t, 4>> samples;
};

// The structures that have a colour (linear) here are looked at. Samples lie at least 0.4 mm apart, and there
// are kMaxSamples at most, however large the structures are. Only those near a structure are computed one by
// one. It takes tenths of a second.
NearStructures nearStructures(const StructureSet& structures,
                              const std::map<uint32_t, Eigen::Vector3f>& colours, double reach);

// What shines through bone of this thickness (m): the structure's share of the colour that is seen, from
// kMostShine where there is no bone before it to 0 at kShineReach and beyond. Light that goes in and comes
// out again falls by half with each 0.4 mm.
constexpr float kMostShine = 0.75f, kShineReach = 2e-3f, kShineLength = 0.6e-3f;
float shineThrough(float thickness);

// These colours (linear) stand for distances from 0 to the reach. They run from dark red through orange and
// yellow to blue: bright and dark tell them apart without hues, too.
constexpr int kThicknessColours = 5;
const std::array<Eigen::Vector3f, kThicknessColours>& thicknessColours();

}  // namespace bonemill

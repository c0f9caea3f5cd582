// It is one contact point as effects see it after the solve.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace bonemill {

struct SurfaceContact {
    Eigen::Vector3f r_V;     // from the tool point to the contact, V axes, m
    Eigen::Vector3f push_V;  // unit: where the bone pushes the tool
    float depth;             // m, > 0
    float force;             // N along push_V
    uint32_t candidate;      // its place among the candidates of the last gathering
};

}  // namespace bonemill

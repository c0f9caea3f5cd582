// Two structures, 3 and 7, that are balls.
#pragma once

#include <Eigen/Core>

#include "render_client/look/structures/structure_set.h"
#include "tests/support/structure_shapes.h"

namespace bonemill::test {

constexpr double kWarning = 3e-3;  // m
const Eigen::Vector3d kNear(0.01, 0.01, 0.01), kFar(0.024, 0.01, 0.01);
constexpr double kNearRadius = 0.004, kFarRadius = 0.002;

inline StructureSet twoBalls() {
    StructureSet structures;
    structures.set(ballStructure(3, kNear, kNearRadius), kWarning);
    structures.set(ballStructure(7, kFar, kFarRadius), kWarning);
    return structures;
}

}  // namespace bonemill::test

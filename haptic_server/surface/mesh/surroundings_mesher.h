// Makes the surface of the bone around the part that is milled, for people to look at: node meshes like all
// others, which never change.
//
// Marching cubes over the scan's own voxels, and around the milled part what joins them to its surface
// (surroundings_joint.h). In each node of the former meshoptimizer then takes triangles away while the
// surface moves by less than kSurroundingsMoved voxels; the nodes' borders stay as they are, so that no crack
// opens. It is not RT-safe (it allocates), but thread-safe.
#pragma once

#include <functional>

#include "common/geometry/node_mesh.h"
#include "haptic_server/core/volume/surroundings.h"
#include "haptic_server/surface/mesh/scan_shade.h"

namespace bonemill {

inline constexpr double kSurroundingsMoved = 0.15;

// How many leaf numbers they take at most.
uint32_t surroundingsLeafCount(const Surroundings& surroundings);

// The sink gets the meshes (V, m), numbered from first_leaf on, in these shades; empty ones do not come.
// False from it ends the work.
using SurroundingsSink = std::function<bool(NodeMesh&&)>;
void meshSurroundings(const Surroundings& surroundings, uint32_t first_leaf, const ShadeScale& shades,
                      const SurroundingsSink& sink);

}  // namespace bonemill

// Which voxels a scene asks about, whatever they are made of: its protected structures and its targets. It is
// for start-up only.
#pragma once

#include <functional>
#include <span>

#include "common/config/scene_file.h"
#include "haptic_server/core/volume/material_properties.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Is the voxel with this index (x fastest) of a protected material, or of a protected or target zone? It is
// empty where none can be. `ids` has one of each voxel, or none if the scene has no materials, and must
// outlive what is returned. Throws UserError for a zone whose shape is no solid.
std::function<bool(size_t)> keptTissueOf(const LoadedScene& loaded, std::span<const MaterialId> ids,
                                         const VolumeGeometry& geometry);

}  // namespace bonemill

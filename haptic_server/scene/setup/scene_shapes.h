// A scene's shapes in SI: of tools in T, of zones in W. It is for start-up only.
#pragma once

#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "common/config/scene_geometry.h"
#include "haptic_server/core/tool/tool_shape.h"
#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Which voxels a zone's shapes hold: one byte per voxel of the volume, x fastest: 1 where its centre is
// inside one of the shapes. `path` is their field in the scene. Throws UserError for a shape that is no
// solid.
std::vector<uint8_t> voxelsInside(const LoadedScene& loaded,
                                  const google::protobuf::RepeatedPtrField<scene::Task::Shape>& shapes,
                                  const VolumeGeometry& geometry, const std::string& path);

// `Shape` is a message with these four kinds; any other is taken for a sphere.
template <class Shape>
ToolShape toolShapeOf(const Shape& shape) {
    if (shape.has_capsule())
        return CapsuleShape{metresOf(shape.capsule().from_mm()), metresOf(shape.capsule().to_mm()),
                            shape.capsule().radius_mm() * kMillimetre};
    if (shape.has_cylinder())
        return CylinderShape{metresOf(shape.cylinder().from_mm()), metresOf(shape.cylinder().to_mm()),
                             shape.cylinder().radius_mm() * kMillimetre,
                             shape.cylinder().edge_radius_mm() * kMillimetre};
    if (shape.has_cone())
        return ConeShape{metresOf(shape.cone().from_mm()), metresOf(shape.cone().to_mm()),
                         shape.cone().from_radius_mm() * kMillimetre,
                         shape.cone().to_radius_mm() * kMillimetre,
                         shape.cone().edge_radius_mm() * kMillimetre};
    return SphereShape{metresOf(shape.sphere().center_mm()), shape.sphere().radius_mm() * kMillimetre};
}

}  // namespace bonemill

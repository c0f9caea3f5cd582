// An analytic body on a whole grid.
#pragma once

#include "haptic_server/cases/phantom/analytic_body.h"

namespace bonemill {

inline RawVolume sampleBody(const AnalyticBody& body, const VolumeGeometry& geometry, double full) {
    RawVolume raw;
    raw.geometry = geometry;
    raw.description = "analytic body";
    raw.values.reserve(geometry.voxelCount());
    for (int k = 0; k < geometry.dims.z(); ++k) raw.values.append(sampleBodySlice(body, geometry, full, k));
    return raw;
}

}  // namespace bonemill

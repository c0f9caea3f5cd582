// What the work has left of the structures that must be spared, and of the bone over them.
//
// A voxel of a structure is lost if it was bone and is none, or was softer and has lost half of its density
// or more. (What is as light as air cannot be seen here; the tick counts what the burr has covered.) Cover is
// measured at each face between the structure and what is around it, along the structure's own normal, which
// is that of its voxels within some voxels; a face stands for its area times the cosine between both, so that
// stairs have the area of the slope. Faces that had no bone over them in the scan do not count.
#pragma once

#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/product/judge.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

struct StructureState {
    std::string name;
    int64_t lost = 0;                                   // voxels
    double exposed = 0, skeletonised = 0, covered = 0;  // m²
};

// In the order of the task's structures. Neither volume may be written meanwhile.
std::vector<StructureState> structuresLeft(const VoxelVolume& scanned, const VoxelVolume& now,
                                           const JudgedTask& task);

// Adds the figures "structure.*".
void addStructureFigures(const std::vector<StructureState>& states, double voxel_volume, Figures& figures);

}  // namespace bonemill

// The bone as files: its surface, its densities, and what was taken from it. For results, not for streaming.
// Not RT-safe.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/mesh/mesh_check.h"
#include "haptic_server/volume/leaf_lattice.h"
#include "haptic_server/volume/voxel_volume.h"

namespace bonemill {

// What a run leaves behind; empty: not written.
struct SavePaths {
    std::string volume;      // .nrrd
    std::string mesh;        // .stl or .ply
    std::string difference;  // .nrrd
};

// Before a run: throws UserError if the file could not be written after it; an empty path is fine. Leaves
// things as they are.
void requireWritable(const std::string& path);
// The same for all of them, also if a name says another format.
void requireWritable(const SavePaths& paths);

std::vector<NodeMesh> meshWholeBone(const VoxelVolume& volume, const LeafLattice& lattice);

// Throw UserError when a file cannot be written.
// By its ending: binary STL, or binary PLY with welded vertices and normals; W, mm.
void saveMesh(const std::string& path, const VoxelVolume& volume, const LeafLattice& lattice,
              const std::vector<NodeMesh>& meshes);
// Density lost (negative: gained) as int16: kFullDifference is a voxel's full density. On one grid.
void saveDifference(const std::string& path, const VoxelVolume& before, const VoxelVolume& after);
inline constexpr int kFullDifference = 32767;

}  // namespace bonemill

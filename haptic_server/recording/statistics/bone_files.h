// The bone becomes files: its surface, its densities, and what was taken from it. They are results, not for
// streaming. It is not RT-safe.
#pragma once

#include <string>
#include <vector>

#include "common/files/require_apart.h"
#include "haptic_server/core/volume/leaf_lattice.h"
#include "haptic_server/core/volume/voxel_volume.h"
#include "haptic_server/surface/mesh/mesh_check.h"

namespace bonemill {

// A run leaves these files behind; those with an empty name are not written.
struct SavePaths {
    std::string volume;      // .nrrd
    std::string mesh;        // .stl or .ply
    std::string difference;  // .nrrd
};

// With the options that name them.
std::vector<NamedFile> filesOf(const SavePaths& paths);

// Called before a run, it throws UserError if the file could not be written after it; an empty path is fine.
// It leaves things as they are.
void requireWritable(const std::string& path);
// Does the same for what is written beside its place first (common/files/whole_file.h).
void requireReplaceable(const std::string& path);
// Does that for all of them, and also throws if a name says another format.
void requireReplaceable(const SavePaths& paths);

std::vector<NodeMesh> meshWholeBone(const VoxelVolume& volume, const LeafLattice& lattice);

// All of these throw UserError when a file cannot be written. The ending chooses binary STL, or binary PLY
// with welded vertices and normals; both are in W and mm.
void saveMesh(const std::string& path, const VoxelVolume& volume, const LeafLattice& lattice,
              const std::vector<NodeMesh>& meshes);
// The file holds the density that was lost (negative: gained) as int16: kFullDifference is a voxel's full
// density. Both volumes must have one grid.
void saveDifference(const std::string& path, const VoxelVolume& before, const VoxelVolume& after);
inline constexpr int kFullDifference = 32767;

}  // namespace bonemill

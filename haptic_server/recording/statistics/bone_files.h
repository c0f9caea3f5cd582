// The bone becomes files: its surface, its densities, and what was taken from it. They are results, not for
// streaming. It is not RT-safe.
#pragma once

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "common/files/require_apart.h"
#include "common/files/whole_file.h"
#include "haptic_server/core/volume/leaf_lattice.h"
#include "haptic_server/core/volume/voxel_volume.h"
#include "haptic_server/surface/mesh/mesh_check.h"

namespace bonemill {

// A run writes its files at its end with this, each on its own: one that fails must not cost the others, nor
// the file of that name which was there before. One normal thread.
class FinalFiles {
  public:
    // Calls write_file(where) unless the path is empty, and notes what it throws; what it writes there gets
    // the path.
    template <class WriteFile>
    void write(const std::string& path, WriteFile&& write_file) {
        if (path.empty()) return;
        try {
            WholeFile file(path);
            write_file(file.part());
            file.finish();
        } catch (const std::exception& error) {
            note(error.what());
        }
    }
    // Something is missing in the files that was found elsewhere.
    void note(std::string problem) { problems_.push_back(std::move(problem)); }

    // One message for each file that is not there or not whole; none when all is well.
    const std::vector<std::string>& problems() const { return problems_; }

  private:
    std::vector<std::string> problems_;
};

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

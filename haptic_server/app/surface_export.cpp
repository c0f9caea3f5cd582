#include "haptic_server/app/surface_export.h"

#include <filesystem>
#include <fstream>

#include "common/config/user_error.h"
#include "haptic_server/mesh/mesher.h"
#include "haptic_server/mesh/stl.h"
#include "haptic_server/volume/import/nrrd_writer.h"

namespace bonemill {

void requireWritable(const std::string& path) {
    if (path.empty()) return;
    const bool is_new = !std::filesystem::exists(path);
    if (!std::ofstream(path, std::ios::app))
        throw UserError(path + ": cannot be written; check that its folder exists and is yours");
    if (is_new) std::filesystem::remove(path);
}

std::vector<NodeMesh> meshWholeBone(const BoneModel& bone) {
    std::vector<NodeMesh> meshes;
    Mesher mesher(bone.volume, bone.lattice);
    mesher.pass([&meshes](NodeMesh&& mesh) { meshes.push_back(std::move(mesh)); });
    return meshes;
}

void saveVolume(const std::string& path, const BoneModel& bone) {
    if (!path.empty()) writeNrrd(path, bone.volume);
}

void saveMesh(const std::string& path, const BoneModel& bone, const std::vector<NodeMesh>& meshes) {
    if (!path.empty())
        saveStl(path, meshes, MeshGrid(bone.volume, bone.lattice), bone.volume.geometry().X_WV);
}

}  // namespace bonemill

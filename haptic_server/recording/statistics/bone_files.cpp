#include "haptic_server/recording/statistics/bone_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "haptic_server/scans/nrrd/nrrd_writer.h"
#include "haptic_server/surface/mesh/mesh_files.h"
#include "haptic_server/surface/mesh/mesher.h"

namespace bonemill {
namespace {

std::string endingOf(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return ending;
}

void requireEnding(const std::string& path, std::initializer_list<const char*> endings, const char* advice) {
    if (path.empty()) return;
    const std::string ending = endingOf(path);
    if (std::find(endings.begin(), endings.end(), ending) == endings.end())
        throw UserError(path + ": " + advice);
}

}  // namespace

std::vector<NamedFile> filesOf(const SavePaths& paths) {
    return {{"--save-volume", paths.volume},
            {"--save-mesh", paths.mesh},
            {"--save-difference", paths.difference}};
}

void requireWritable(const std::string& path) {
    if (path.empty()) return;
    requireNoPipe(path);
    const bool is_new = !std::filesystem::exists(path);
    if (!std::ofstream(path, std::ios::app))
        throw UserError(path + ": cannot be written; check that its folder exists and is yours");
    if (is_new) std::filesystem::remove(std::filesystem::canonical(path));  // not the link that leads there
}

void requireReplaceable(const std::string& path) {
    requireWritable(path);
    if (!path.empty()) WholeFile{path};
}

void requireReplaceable(const SavePaths& paths) {
    requireEnding(paths.mesh, {".stl", ".ply"}, "a surface is saved as .stl or .ply; name one of them");
    for (const std::string& path : {paths.volume, paths.difference})
        requireEnding(path, {".nrrd"}, "volumes are saved as .nrrd; name it so");
    for (const std::string& path : {paths.volume, paths.mesh, paths.difference}) requireReplaceable(path);
}

std::vector<NodeMesh> meshWholeBone(const VoxelVolume& volume, const LeafLattice& lattice) {
    std::vector<NodeMesh> meshes;
    Mesher mesher(volume, lattice);
    mesher.pass([&meshes](NodeMesh&& mesh) { meshes.push_back(std::move(mesh)); });
    return meshes;
}

void saveMesh(const std::string& path, const VoxelVolume& volume, const LeafLattice& lattice,
              const std::vector<NodeMesh>& meshes) {
    const MeshGrid grid(volume, lattice);
    const Pose& X_WV = volume.geometry().X_WV;
    if (endingOf(path) == ".ply")
        savePly(path, meshes, grid, X_WV);
    else
        saveStl(path, meshes, grid, X_WV);
}

void saveDifference(const std::string& path, const VoxelVolume& before, const VoxelVolume& after) {
    const Eigen::Vector3i& n = before.dims();
    NrrdStream<int16_t> file(path, before.geometry());
    std::vector<int16_t> row(size_t(n.x()));
    for (int k = 0; k < n.z(); ++k)
        for (int j = 0; j < n.y(); ++j) {
            for (int i = 0; i < n.x(); ++i) {
                const int lost = int(before.at(i, j, k)) - int(after.at(i, j, k));
                row[size_t(i)] = int16_t(std::lround(double(lost) * kFullDifference / kMaxDensity));
            }
            file.append(row);
        }
    file.close();
}

}  // namespace bonemill

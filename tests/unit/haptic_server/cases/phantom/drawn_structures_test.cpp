// The drawn surfaces of a temporal bone's structures hold as much as the shapes that their labels were made
// of: what is smoothed neither shrinks nor, where it is thin, vanishes.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/base/units.h"
#include "haptic_server/cases/phantom/temporal_bone_phantom.h"
#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/surface/mesh/structure_mesher.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using enum TemporalTissue;

constexpr double kDrawnVoxel = 0.2e-3;  // m, as the shipped scene's
constexpr double kMostError = 0.03;

VolumeGeometry gridOfBox(const Eigen::AlignedBox3d& box, double voxel) {
    VolumeGeometry geometry;
    geometry.dims = (box.sizes() / voxel).array().floor().cast<int>() + 1;
    geometry.spacing.setConstant(voxel);
    geometry.X_WV.position = box.min();
    return geometry;
}

template <class See>
void forEachIn(const VolumeGeometry& grid, See&& see) {
    size_t n = 0;
    forEachIndex({Eigen::Vector3i::Zero(), (grid.dims.array() - 1).matrix()}, [&](const Eigen::Vector3i& v) {
        see(n++, v, Vector3d(grid.X_WV * grid.spacing.cwiseProduct(v.cast<double>())));
    });
}

// The small structures with what is around them, found on a coarse grid.
Eigen::AlignedBox3d boxOfEar(const TemporalBone& bone) {
    const VolumeGeometry coarse = bone.grid(0.8e-3);
    Eigen::AlignedBox3d box;
    forEachIn(coarse, [&](size_t, const Eigen::Vector3i&, const Vector3d& p) {
        if (std::min(bone.distance(kSemicircularCanals, p), bone.distance(kOssicles, p)) < 0.8e-3)
            box.extend(p);
    });
    return {box.min() - Vector3d::Constant(1e-3), box.max() + Vector3d::Constant(1e-3)};
}

double drawnVolume(const NodeMesh& mesh) {
    const auto place = [&](uint32_t index) {
        const PackedVertex& v = mesh.vertices[index];
        return Vector3d(
            (mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z))).cast<double>());
    };
    double sum = 0;
    for (size_t n = 0; n < mesh.indices.size(); n += 3)
        sum += place(mesh.indices[n]).dot(place(mesh.indices[n + 1]).cross(place(mesh.indices[n + 2]))) / 6;
    return sum;
}

// Voxels that the surface cuts count by the part that lies inside.
double trueVolume(const TemporalBone& bone, TemporalTissue tissue, const VolumeGeometry& grid) {
    double sum = 0;
    forEachIn(grid, [&](size_t, const Eigen::Vector3i&, const Vector3d& p) {
        sum += std::clamp(0.5 - bone.distance(tissue, p) / kDrawnVoxel, 0.0, 1.0);
    });
    return sum * kDrawnVoxel * kDrawnVoxel * kDrawnVoxel;
}

TEST(DrawnStructures, HoldAsMuchAsTheirShapes) {
    for (const uint64_t seed : {1, 5}) {
        TemporalBoneKind kind;
        kind.seed = seed;
        const TemporalBone bone(kind);
        const VolumeGeometry grid = gridOfBox(boxOfEar(bone), kDrawnVoxel);
        const TemporalScan scan = bone.scan(grid);
        const VoxelVolume volume(grid, 1000);
        const auto materialAt = [&](const Eigen::Vector3i& v) {
            return MaterialId(
                scan.labels[size_t(v.x()) +
                            size_t(grid.dims.x()) * (size_t(v.y()) + size_t(grid.dims.y()) * size_t(v.z()))]);
        };
        MaterialTable table(6);
        for (size_t n = 1; n < table.size(); ++n) table[n].is_protected = true;
        const std::vector<NodeMesh> drawn =
            meshStructures(BoneProperties(volume, materialAt), table, grid.spacing);
        for (const TemporalTissue tissue : {kSemicircularCanals, kOssicles, kFacialNerve}) {
            const auto mesh = std::ranges::find(drawn, uint32_t(tissue), &NodeMesh::leaf);
            ASSERT_NE(mesh, drawn.end()) << int(tissue);
            const double whole = trueVolume(bone, tissue, grid), error = drawnVolume(*mesh) / whole - 1;
            RecordProperty(
                "seed_" + std::to_string(seed) + "_tissue_" + std::to_string(int(tissue)),
                std::to_string(whole * kPerCubicMillimetre) + " mm3, " + std::to_string(100 * error) + " %");
            EXPECT_LE(std::abs(error), kMostError)
                << "seed " << seed << ", tissue " << int(tissue) << ": " << error;
        }
    }
}

}  // namespace
}  // namespace bonemill

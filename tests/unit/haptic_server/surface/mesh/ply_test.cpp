#include <gtest/gtest.h>

#include <optional>

#include "common/base/user_error.h"
#include "haptic_server/surface/mesh/mesh_check.h"
#include "haptic_server/surface/mesh/mesh_files.h"
#include "tests/support/ply_reader.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

class PlyTest : public testing::Test {
  protected:
    PlyTest() : volume_(test::boxGeometry({25, 22, 28}), 32768) {
        std::mt19937 random(9);
        test::fillWaves(volume_, random);
        lattice_.emplace(volume_, Eigen::Vector3i(7, 7, 7));
        grid_.emplace(volume_, *lattice_);
        meshes_ = test::meshAll(volume_, *lattice_);
        X_WV_.position = {0.123, -0.045, 0.2};
        X_WV_.rotation = expRotation({0.3, -0.7, 1.1});
    }

    test::TemporaryFolder folder_;
    VoxelVolume volume_;
    std::optional<LeafLattice> lattice_;
    std::optional<MeshGrid> grid_;
    std::vector<NodeMesh> meshes_;
    Pose X_WV_;
};

TEST_F(PlyTest, IsOneClosedSurfaceInMillimetres) {
    savePly(folder_ / "a.ply", meshes_, *grid_, X_WV_);
    const test::PlyMesh mesh = test::readPly(folder_ / "a.ply");
    const MeshCheck check = checkMesh(meshes_, *grid_);
    EXPECT_EQ(mesh.triangles.size(), check.triangles);
    EXPECT_EQ(mesh.points.size(), check.vertices);
    EXPECT_TRUE(mesh.isClosed());
    EXPECT_NEAR(mesh.volume(), check.volume * 1e9, 1e-4 * check.volume * 1e9);
}

TEST_F(PlyTest, LiesWhereTheBoneLies) {
    savePly(folder_ / "a.ply", meshes_, *grid_, X_WV_);
    const test::PlyMesh mesh = test::readPly(folder_ / "a.ply");
    Eigen::AlignedBox3d box, expected;
    for (const Eigen::Vector3f& p : mesh.points) box.extend(p.cast<double>());
    for (const NodeMesh& node : meshes_)
        for (const PackedVertex& v : node.vertices)
            expected.extend(X_WV_ * grid_->position(grid_->stepsOf(node.leaf, v)) * 1e3);
    EXPECT_LT((box.min() - expected.min()).norm(), 1e-4);
    EXPECT_LT((box.max() - expected.max()).norm(), 1e-4);
}

TEST_F(PlyTest, NormalsPointOutOfTheBone) {
    savePly(folder_ / "a.ply", meshes_, *grid_, X_WV_);
    const test::PlyMesh mesh = test::readPly(folder_ / "a.ply");
    double along = 0, area = 0;
    for (const auto& t : mesh.triangles) {
        const Eigen::Vector3f n =
            (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]);
        area += 3 * n.norm();
        for (const uint32_t corner : t) along += n.dot(mesh.normals[corner]);
    }
    for (const Eigen::Vector3f& normal : mesh.normals) EXPECT_NEAR(normal.norm(), 1, 1e-5);
    EXPECT_GT(along, 0.9 * area);
}

TEST_F(PlyTest, UnwritablePathIsAUserError) {
    EXPECT_THROW(savePly(folder_ / "none/a.ply", meshes_, *grid_, X_WV_), UserError);
    EXPECT_THROW(savePly("/dev/full", meshes_, *grid_, X_WV_), UserError);
}

}  // namespace
}  // namespace bonemill

// The checker must see what is wrong, or the tests that rely on it prove nothing.
#include "haptic_server/surface/mesh/mesh_check.h"

#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

class MeshCheckTest : public testing::Test {
  protected:
    MeshCheckTest() : volume_(test::boxGeometry({12, 12, 12}), 30000) {
        test::forEachVoxel({{3, 4, 3}, {8, 9, 7}},
                           [&](int i, int j, int k) { volume_.set(i, j, k, kMaxDensity); });
        lattice_.emplace(volume_, Eigen::Vector3i(6, 6, 6));
        meshes_ = test::meshAll(volume_, *lattice_);
    }
    MeshCheck check() const { return checkMesh(meshes_, MeshGrid(volume_, *lattice_)); }

    VoxelVolume volume_;
    std::optional<LeafLattice> lattice_;
    std::vector<NodeMesh> meshes_;
};

TEST_F(MeshCheckTest, BoxIsClosedAndEulerHolds) {
    const MeshCheck good = check();
    EXPECT_TRUE(good.isClosed());
    EXPECT_EQ(good.vertices + good.triangles, good.triangles * 3 / 2 + 2);
}

TEST_F(MeshCheckTest, SeesAMissingTriangle) {
    meshes_[0].indices.resize(meshes_[0].indices.size() - 3);
    EXPECT_EQ(check().open_edges, 3u);
    EXPECT_FALSE(check().isClosed());
}

TEST_F(MeshCheckTest, SeesAMissingLeaf) {
    meshes_.pop_back();
    EXPECT_GT(check().open_edges, 0u);
}

TEST_F(MeshCheckTest, SeesADoubledTriangle) {
    auto& indices = meshes_[0].indices;
    indices.insert(indices.end(), {indices[0], indices[1], indices[2]});
    EXPECT_EQ(check().crowded_edges, 3u);
    EXPECT_FALSE(check().isClosed());
}

TEST_F(MeshCheckTest, SeesAFlippedTriangle) {
    std::swap(meshes_[0].indices[0], meshes_[0].indices[1]);
    EXPECT_EQ(check().misoriented_edges, 3u);
    EXPECT_FALSE(check().isClosed());
}

TEST_F(MeshCheckTest, SeesALeafShiftedByOneStep) {
    for (PackedVertex& v : meshes_[0].vertices) ++v.x;
    EXPECT_GT(check().open_edges, 0u);
}

TEST_F(MeshCheckTest, VolumeIsSignedAndThatOfTheBox) {
    const double inside_out = -meshVolume(meshes_, MeshGrid(volume_, *lattice_));
    for (NodeMesh& mesh : meshes_)
        for (size_t i = 0; i < mesh.indices.size(); i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
    EXPECT_DOUBLE_EQ(check().volume, inside_out);
    // Faces lie 1 - 30000/65535 of a cell beyond the outer voxels; only the cut edges make the box smaller.
    const double overhang = 2 * (1 - 30000.0 / 65535);
    const double box = (5 + overhang) * (5 + overhang) * (4 + overhang) * volume_.voxelVolume();
    EXPECT_LT(-check().volume, box);
    EXPECT_GT(-check().volume, 0.95 * box);
}

TEST(MeshCheck, NothingIsClosed) {
    const VoxelVolume volume(test::boxGeometry({4, 4, 4}), 30000);
    const LeafLattice lattice(volume, {4, 4, 4});
    const MeshCheck check = checkMesh({}, MeshGrid(volume, lattice));
    EXPECT_TRUE(check.isClosed());
    EXPECT_EQ(check.volume, 0);
}

}  // namespace
}  // namespace bonemill

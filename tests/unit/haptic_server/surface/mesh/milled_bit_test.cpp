#include <gtest/gtest.h>

#include <map>

#include "haptic_server/surface/mesh/mesher.h"
#include "haptic_server/surface/mesh/zone_paint.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kMilledVoxel = 4e-4;
constexpr int kMilledSize = 40;
const Vector3d kMilledBallAt = Vector3d::Constant(kMilledVoxel * (kMilledSize - 1) / 2.0);
constexpr double kMilledBallRadius = 5.5e-3, kNotchRadius = 2.2e-3;
const Vector3d kNotchAt = kMilledBallAt + Vector3d(0.6e-3, -5e-3, 0.9e-3);
constexpr double kRounding = 0.06 * kMilledVoxel;  // of the densities' linear interpolation, and more

Density densityAt(double depth) {
    return Density(std::clamp(32768 + depth / kMilledVoxel * 12000, 0.0, double(kMaxDensity)));
}
double depthInMilledBall(const Vector3d& p) {
    return kMilledBallRadius - (p - kMilledBallAt).norm();
}
Density wholeAt(int i, int j, int k) {
    return densityAt(depthInMilledBall(kMilledVoxel * Vector3d(i, j, k)));
}
Density notchedAt(int i, int j, int k) {
    const Vector3d p = kMilledVoxel * Vector3d(i, j, k);
    return std::min(wholeAt(i, j, k), densityAt((p - kNotchAt).norm() - kNotchRadius));
}

class MilledBit : public testing::Test {
  protected:
    MilledBit()
        : now(test::boxGeometry(Vector3i::Constant(kMilledSize), Vector3d::Constant(kMilledVoxel)), 32768),
          scanned(now),
          lattice(now, {8, 8, 8}) {
        now.fill(wholeAt);
        scanned.fill(wholeAt);
    }
    template <class DensityOf>
    void write(DensityOf&& density_of) {
        const IndexBox box{{12, 0, 12}, {30, 20, 32}};
        test::writeLikeTick(now, lattice, box, density_of);
    }
    static std::map<LeafId, NodeMesh> meshesOf(Mesher& mesher) {
        std::map<LeafId, NodeMesh> meshes;
        mesher.pass([&](NodeMesh&& mesh) { meshes.insert_or_assign(mesh.leaf, std::move(mesh)); });
        return meshes;
    }
    VertexLook look() const { return {nullptr, nullptr, &scanned}; }

    VoxelVolume now, scanned;
    LeafLattice lattice;
};

TEST_F(MilledBit, IsWhereTheScanHadBoneAndNowhereElse) {
    Mesher mesher(now, lattice, MeshGrid::kStreamedStepsPerCell, look());
    for (const auto& [leaf, mesh] : meshesOf(mesher)) EXPECT_TRUE(mesh.materials.empty()) << leaf;
    write(notchedAt);
    size_t inside = 0, outside = 0;
    for (const auto& [leaf, mesh] : meshesOf(mesher))
        for (size_t n = 0; n < mesh.vertices.size(); ++n) {
            const PackedVertex& v = mesh.vertices[n];
            const Vector3d p =
                (mesh.origin + mesh.step.cwiseProduct(Eigen::Vector3f(v.x, v.y, v.z))).cast<double>();
            const bool is_milled = !mesh.materials.empty() && (mesh.materials[n] & kMilledBit);
            if (depthInMilledBall(p) > kRounding) {
                ++inside;
                EXPECT_TRUE(is_milled) << p.transpose();
                EXPECT_LT((p - kNotchAt).norm(), kNotchRadius + kMilledVoxel);
            } else if ((p - kNotchAt).norm() > kNotchRadius + kMilledVoxel) {  // its rim lies between voxels
                ++outside;
                EXPECT_FALSE(is_milled) << p.transpose();
            }
        }
    EXPECT_GT(inside, 100u);
    EXPECT_GT(outside, 100u);
}

TEST_F(MilledBit, AMeshMadeLaterSaysTheSame) {
    Mesher mesher(now, lattice, MeshGrid::kStreamedStepsPerCell, look());
    std::map<LeafId, NodeMesh> changed = meshesOf(mesher);
    write(notchedAt);
    for (auto& [leaf, mesh] : meshesOf(mesher)) changed.insert_or_assign(leaf, std::move(mesh));
    std::erase_if(changed, [](const auto& node) { return node.second.isEmpty(); });
    Mesher late(now, lattice, MeshGrid::kStreamedStepsPerCell, look());
    const std::map<LeafId, NodeMesh> joined = meshesOf(late);
    ASSERT_EQ(joined.size(), changed.size());
    for (const auto& [leaf, mesh] : joined) EXPECT_TRUE(test::sameMesh(mesh, changed.at(leaf))) << leaf;
}

TEST_F(MilledBit, BoneThatIsPutBackHasNone) {
    write(notchedAt);
    write(wholeAt);
    Mesher mesher(now, lattice, MeshGrid::kStreamedStepsPerCell, look());
    for (const auto& [leaf, mesh] : meshesOf(mesher)) EXPECT_TRUE(mesh.materials.empty()) << leaf;
}

TEST_F(MilledBit, GoesWithTheMaterialUnlessAZoneHasSomethingToShow) {
    const BoneProperties properties(scanned, [](const Vector3i&) { return MaterialId(5); });
    std::vector<uint8_t> ids;
    forEachIndex(test::wholeBox(now), [&](const Vector3i& v) { ids.push_back(v.x() < 21 ? 1 : 2); });
    ZonePaint paint;
    paint.zones = std::make_shared<const VoxelIds>(now.dims(), ids);
    paint.scanned = &scanned;
    paint.when_gone[1] = 9;
    Mesher mesher(now, lattice, MeshGrid::kStreamedStepsPerCell, {&properties, nullptr, &scanned});
    mesher.setPaint(&paint);
    write(notchedAt);
    std::map<int, size_t> shown;
    for (const auto& [leaf, mesh] : meshesOf(mesher))
        for (const uint8_t material : mesh.materials) ++shown[material];
    EXPECT_EQ(shown.size(), 3u);
    EXPECT_GT(shown[5], 100u);
    EXPECT_GT(shown[9], 20u);
    EXPECT_GT(shown[5 | kMilledBit], 20u);
}

}  // namespace
}  // namespace bonemill

#include "haptic_server/surface/mesh/zone_paint.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "haptic_server/surface/mesh/mesher.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

// A block of bone below z = 12, with two zones: 1 left and 2 right of x = 10.
class ZonePainting : public testing::Test {
  protected:
    ZonePainting() : now(test::boxGeometry({24, 24, 24}), 32768), scanned(now) {
        const auto density = [](int, int, int k) { return k < 12 ? kMaxDensity : Density(0); };
        now.fill(density);
        scanned.fill(density);
        std::vector<uint8_t> ids;
        forEachIndex(test::wholeBox(now),
                     [&](const Eigen::Vector3i& v) { ids.push_back(v.x() < 10 ? 1 : 2); });
        paint.zones = std::make_shared<const VoxelIds>(now.dims(), ids);
        paint.scanned = &scanned;
        paint.when_left[1] = 7;
        paint.when_gone[2] = 8;
    }
    static std::set<int> shown(const std::vector<NodeMesh>& meshes) {
        std::set<int> all;
        for (const NodeMesh& mesh : meshes) all.insert(mesh.materials.begin(), mesh.materials.end());
        return all;
    }

    VoxelVolume now, scanned;
    ZonePaint paint;
};

TEST_F(ZonePainting, whatIsLeftAndWhatIsGoneHaveTheirColours) {
    LeafLattice lattice(now, {8, 8, 8});
    Mesher mesher(now, lattice);
    std::vector<NodeMesh> meshes;
    const auto take = [&](NodeMesh&& mesh) { meshes.push_back(std::move(mesh)); };
    mesher.pass(take);
    EXPECT_EQ(shown(meshes), (std::set<int>{}));
    const uint32_t before = meshes.front().revision;

    meshes.clear();
    mesher.setPaint(&paint);
    mesher.pass(take);
    EXPECT_EQ(shown(meshes), (std::set<int>{0, 7}));  // nothing of zone 2 is gone
    EXPECT_GT(meshes.front().revision, before);
    EXPECT_TRUE(mesher.hasMeshedAll());

    // A pit across both zones: its walls show zone 2 where it was taken away, zone 1 where it is left.
    meshes.clear();
    test::writeLikeTick(now, lattice, {{7, 7, 8}, {13, 13, 11}}, [](int, int, int) { return Density(0); });
    mesher.pass(take);
    EXPECT_EQ(shown(meshes), (std::set<int>{0, 7, 8}));

    // Without paint all that showed it comes again, and shows nothing.
    meshes.clear();
    mesher.setPaint(nullptr);
    mesher.pass(take);
    EXPECT_FALSE(meshes.empty());
    EXPECT_EQ(shown(meshes), (std::set<int>{}));
}

TEST_F(ZonePainting, everyMeshOfALeafIsNewerThanTheOneBefore) {
    LeafLattice lattice(now, {8, 8, 8});
    Mesher mesher(now, lattice);
    std::map<LeafId, uint32_t> last;
    const auto take = [&](NodeMesh&& mesh) {
        if (last.contains(mesh.leaf)) {
            EXPECT_GT(mesh.revision, last[mesh.leaf]);
        }
        last[mesh.leaf] = mesh.revision;
    };
    mesher.pass(take);
    for (int round = 0; round < 6; ++round) {
        if (round % 2 == 0) mesher.setPaint(round % 4 == 0 ? &paint : nullptr);
        test::writeLikeTick(now, lattice, {{7, 7, 11 - round}, {13, 13, 11}},
                            [](int, int, int) { return Density(0); });
        mesher.pass(take);
    }
    EXPECT_FALSE(last.empty());
}

// The painted mesh that grew with the cuts is that of a mesher that sees the bone only in the end.
TEST_F(ZonePainting, incrementalIsWhole) {
    std::mt19937 random(3);
    LeafLattice lattice(now, {8, 8, 8});
    Mesher mesher(now, lattice);
    mesher.setPaint(&paint);
    std::map<LeafId, NodeMesh> kept;
    const auto keep = [&](NodeMesh&& mesh) { kept[mesh.leaf] = std::move(mesh); };
    mesher.pass(keep);
    for (int round = 0; round < 20; ++round) {
        test::writeLikeTick(now, lattice, test::randomBox(now, 9, random),
                            [&](int, int, int) { return Density(random() % 65536); });
        mesher.pass(keep);
    }
    Mesher whole(now, lattice);
    whole.setPaint(&paint);
    whole.pass([&](NodeMesh&& mesh) { EXPECT_TRUE(test::sameMesh(mesh, kept[mesh.leaf])); });
}

}  // namespace
}  // namespace bonemill

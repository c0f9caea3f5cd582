#include "haptic_server/surface/mesh/difference_paint.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "haptic_server/surface/mesh/mesher.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

constexpr uint8_t kFirst = 20;
constexpr uint8_t kHere = kFirst, kThere = kFirst + 1, kBoth = kFirst + 2;

// Two blocks of bone below z = 12, milled one by one.
class DifferencePainting : public testing::Test {
  protected:
    static VoxelVolume block() {
        VoxelVolume volume(test::boxGeometry({24, 24, 24}), 32768);
        volume.fill([](int, int, int k) { return k < 12 ? kMaxDensity : Density(0); });
        return volume;
    }
    static BoneModel boneOf(VoxelVolume volume) { return {std::move(volume), {8, 8, 8}, ShellConfig{}}; }

    static void mill(BoneModel& bone, const IndexBox& voxels, Density density = 0) {
        test::writeLikeTick(bone.volume, bone.lattice, voxels, [=](int, int, int) { return density; });
    }
    static std::set<int> shown(const std::map<LeafId, NodeMesh>& meshes) {
        std::set<int> all;
        for (const auto& [leaf, mesh] : meshes) all.insert(mesh.materials.begin(), mesh.materials.end());
        return all;
    }
    Mesher::Sink keep() {
        return [this](NodeMesh&& mesh) {
            const auto before = kept_.find(mesh.leaf);
            if (before != kept_.end()) {
                EXPECT_GT(mesh.revision, before->second.revision);
            }
            kept_[mesh.leaf] = std::move(mesh);
        };
    }

    const VoxelVolume scanned_ = block();
    BoneModel here_ = boneOf(block());
    std::shared_ptr<BoneModel> there_ = std::make_shared<BoneModel>(boneOf(block()));
    DifferencePaint paint_{scanned_, here_.volume, there_, kFirst};
    std::map<LeafId, NodeMesh> kept_;  // as a client has them
};

TEST_F(DifferencePainting, AnEdgeTellsWhoHasRemovedWhat) {
    mill(here_, {{2, 2, 10}, {9, 9, 11}});
    mill(*there_, {{6, 2, 10}, {15, 9, 11}});
    const Eigen::Vector3i up = Eigen::Vector3i::UnitZ();
    const auto under = [&](int x, int z) { return paint_.between({x, 5, z}, Eigen::Vector3i(x, 5, z) + up); };
    EXPECT_EQ(under(4, 9), kHere);
    EXPECT_EQ(under(7, 9), kBoth);
    EXPECT_EQ(under(12, 11), kThere) << "the bone that is there still";
    EXPECT_EQ(under(20, 11), 0) << "as it was scanned";
    mill(*there_, {{2, 2, 9}, {9, 9, 9}});
    EXPECT_EQ(under(7, 9), kThere) << "the other one went on";
    EXPECT_EQ(paint_.between({0, 5, 11}, {-1, 5, 11}), 0) << "beyond the volume nothing was removed";
    EXPECT_TRUE(paint_.mayPaint({{0, 0, 0}, {3, 3, 12}}));
    EXPECT_FALSE(paint_.mayPaint({{17, 0, 0}, {23, 23, 23}}));
}

TEST_F(DifferencePainting, TheMesherFollowsTheOtherBone) {
    Mesher mesher(here_.volume, here_.lattice);
    mesher.pass(keep());
    mesher.setPaint(&paint_);
    mesher.pass(keep());
    EXPECT_EQ(shown(kept_), (std::set<int>{}));
    mill(*there_, {{2, 2, 10}, {9, 9, 11}});
    mesher.pass(keep());
    EXPECT_EQ(shown(kept_), (std::set<int>{0, kThere})) << "without a change of the meshed bone";
    EXPECT_EQ(mesher.pass(keep()).read, 0u) << "nothing is due any more";
    mill(here_, {{6, 2, 10}, {15, 9, 11}});
    mesher.pass(keep());
    EXPECT_EQ(shown(kept_), (std::set<int>{0, kHere, kThere, kBoth}));
    mill(*there_, {{2, 2, 10}, {9, 9, 11}}, kMaxDensity);
    mesher.pass(keep());
    EXPECT_EQ(shown(kept_), (std::set<int>{0, kHere})) << "the other bone was put back";
}

// A leaf that showed something shows nothing without paint, also if the other bone was put back just then.
TEST_F(DifferencePainting, WithoutPaintNothingIsLeftOfIt) {
    Mesher mesher(here_.volume, here_.lattice);
    mesher.setPaint(&paint_);
    mill(*there_, {{2, 2, 10}, {9, 9, 11}});
    mesher.pass(keep());
    ASSERT_EQ(shown(kept_), (std::set<int>{0, kThere}));
    mill(*there_, {{2, 2, 10}, {9, 9, 11}}, kMaxDensity);
    mesher.setPaint(nullptr);
    mesher.pass(keep());
    EXPECT_EQ(shown(kept_), (std::set<int>{}));
}

// What has grown with both bones is the mesh of a mesher that sees both only in the end.
TEST_F(DifferencePainting, IncrementalIsWhole) {
    std::mt19937 random(7);
    Mesher mesher(here_.volume, here_.lattice);
    mesher.setPaint(&paint_);
    mesher.pass(keep());
    for (int round = 0; round < 20; ++round) {
        BoneModel& bone = round % 2 == 0 ? here_ : *there_;
        test::writeLikeTick(bone.volume, bone.lattice, test::randomBox(bone.volume, 9, random),
                            [&](int, int, int) { return Density(random() % 65536); });
        mesher.pass(keep());
    }
    Mesher whole(here_.volume, here_.lattice);
    whole.setPaint(&paint_);
    size_t leaves = 0;
    whole.pass([&](NodeMesh&& mesh) {
        EXPECT_TRUE(test::sameMesh(mesh, kept_[mesh.leaf]));
        ++leaves;
    });
    EXPECT_GT(leaves, 0u);
}

}  // namespace
}  // namespace bonemill

#include "haptic_server/surface/mesh/mesher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <optional>
#include <thread>

#include "haptic_server/surface/mesh/mesh_check.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using test::boxGeometry;
using test::writeLikeTick;

constexpr Density kMesherIso = 30000;

// A client keeps the newest mesh of each leaf; an empty one removes it.
struct Model {
    std::map<LeafId, NodeMesh> meshes;
    size_t received = 0;
    size_t removals_of_nothing = 0;

    void accept(NodeMesh&& mesh) {
        ++received;
        if (mesh.isEmpty()) {
            if (meshes.erase(mesh.leaf) == 0) ++removals_of_nothing;
        } else {
            meshes[mesh.leaf] = std::move(mesh);
        }
    }
    Mesher::Sink sink() {
        return [this](NodeMesh&& mesh) { accept(std::move(mesh)); };
    }
};

void expectEqualsFullRemesh(const Model& model, const VoxelVolume& volume, const LeafLattice& lattice,
                            const BoneProperties* properties = nullptr) {
    const std::vector<NodeMesh> full = test::meshAll(volume, lattice, properties);
    ASSERT_EQ(model.meshes.size(), full.size());
    for (const NodeMesh& expected : full) {
        const auto found = model.meshes.find(expected.leaf);
        ASSERT_NE(found, model.meshes.end());
        EXPECT_TRUE(test::sameMesh(found->second, expected)) << "leaf " << expected.leaf;
    }
    EXPECT_EQ(model.removals_of_nothing, 0u);
}

struct Bone {
    explicit Bone(const Eigen::Vector3i& dims, const Eigen::Vector3i& leaf_cells, unsigned seed = 1)
        : random(seed), volume(boxGeometry(dims), kMesherIso) {
        test::fillWaves(volume, random);
        lattice.emplace(volume, leaf_cells);
    }
    std::mt19937 random;
    VoxelVolume volume;
    std::optional<LeafLattice> lattice;
};

TEST(Mesher, FirstPassIsTheFullMeshAndTheSecondIsSilent) {
    Bone bone({40, 30, 35}, {8, 8, 8});
    Mesher mesher(bone.volume, *bone.lattice);
    Model model;
    EXPECT_EQ(mesher.pass(model.sink()).read, bone.lattice->leafCount());
    expectEqualsFullRemesh(model, bone.volume, *bone.lattice);
    const size_t received = model.received;
    const Mesher::PassResult second = mesher.pass(model.sink());
    EXPECT_EQ(second.read, 0u);
    EXPECT_EQ(second.pending, 0u);
    EXPECT_EQ(model.received, received);
}

TEST(Mesher, ReadsOnlyLeavesNearTheChange) {
    Bone bone({64, 64, 64}, {8, 8, 8});
    Mesher mesher(bone.volume, *bone.lattice);
    Model model;
    mesher.pass(model.sink());
    // Voxels 20 and 21 reach cells 18 to 22, all of leaf 2 (15 to 22); voxel 22 reaches cell 23 of leaf
    // 3 too.
    writeLikeTick(bone.volume, *bone.lattice, {{20, 20, 20}, {21, 21, 21}},
                  [](int, int, int) { return Density(0); });
    EXPECT_EQ(mesher.pass(model.sink()).read, 1u);
    writeLikeTick(bone.volume, *bone.lattice, {{21, 21, 21}, {22, 22, 21}},
                  [](int, int, int) { return Density(0); });
    EXPECT_EQ(mesher.pass(model.sink()).read, 4u);
    expectEqualsFullRemesh(model, bone.volume, *bone.lattice);
}

TEST(Mesher, CatchUpReadsOnlyTheNamedLeavesThatChanged) {
    Bone bone({64, 64, 64}, {8, 8, 8});
    Mesher mesher(bone.volume, *bone.lattice);
    Model model;
    mesher.pass(model.sink());
    const IndexBox here{{20, 20, 20}, {21, 21, 21}}, elsewhere{{44, 44, 44}, {45, 45, 45}};
    for (const IndexBox& box : {here, elsewhere})
        writeLikeTick(bone.volume, *bone.lattice, box,
                      [](int i, int, int) { return Density(i % 2 * 40000); });
    const size_t before = model.received;
    const IndexBox around_here{{1, 1, 1}, {3, 3, 3}};
    EXPECT_TRUE(mesher.catchUp(around_here, model.sink()));
    EXPECT_EQ(model.received, before + 1);
    EXPECT_TRUE(mesher.catchUp(around_here, model.sink()));
    EXPECT_EQ(model.received, before + 1);
    EXPECT_EQ(mesher.pass(model.sink()).read, 1u);  // elsewhere
    expectEqualsFullRemesh(model, bone.volume, *bone.lattice);
}

TEST(Mesher, CatchUpSaysWhenALeafIsBeingWritten) {
    Bone bone({32, 32, 32}, {8, 8, 8});
    Mesher mesher(bone.volume, *bone.lattice);
    Model model;
    const IndexBox box{{20, 20, 20}, {21, 21, 21}}, leaf{{2, 2, 2}, {2, 2, 2}};
    bone.lattice->beginWrite(box);
    EXPECT_FALSE(mesher.catchUp(leaf, model.sink()));
    EXPECT_EQ(model.received, 0u);
    bone.lattice->endWrite(box);
    EXPECT_TRUE(mesher.catchUp(leaf, model.sink()));
}

TEST(Mesher, LeafWithoutSurfaceIsNeverSentAndAnEmptiedOneOnce) {
    VoxelVolume volume(boxGeometry({30, 30, 30}), kMesherIso);
    volume.set(5, 5, 5, kMaxDensity);
    LeafLattice lattice(volume, {10, 10, 10});
    Mesher mesher(volume, lattice);
    Model model;
    mesher.pass(model.sink());
    EXPECT_EQ(model.received, 1u);
    ASSERT_EQ(model.meshes.size(), 1u);
    EXPECT_EQ(model.meshes.begin()->first, 0u);

    const IndexBox box{{5, 5, 5}, {5, 5, 5}};
    for (int repeat = 0; repeat < 2; ++repeat) {
        writeLikeTick(volume, lattice, box, [](int, int, int) { return Density(0); });
        EXPECT_EQ(mesher.pass(model.sink()).read, 1u);
        EXPECT_EQ(model.received, 2u);
        EXPECT_TRUE(model.meshes.empty());
    }
    writeLikeTick(volume, lattice, box, [](int, int, int) { return kMaxDensity; });
    mesher.pass(model.sink());
    ASSERT_EQ(model.meshes.size(), 1u);
    EXPECT_EQ(model.meshes.begin()->second.revision, lattice.version(0));
}

TEST(Mesher, LeavesBeingWrittenWait) {
    Bone bone({32, 32, 32}, {8, 8, 8});
    Mesher mesher(bone.volume, *bone.lattice);
    const IndexBox box{{15, 15, 15}, {16, 16, 16}};
    bone.lattice->beginWrite(box);
    Model model;
    const Mesher::PassResult during = mesher.pass(model.sink());
    EXPECT_GT(during.pending, 0u);
    EXPECT_EQ(during.read + during.pending, bone.lattice->leafCount());
    ASSERT_GT(model.meshes.size(), 0u);
    for (const auto& [leaf, mesh] : model.meshes) EXPECT_EQ(bone.lattice->version(leaf) % 2, 0u);
    bone.lattice->endWrite(box);
    const Mesher::PassResult after = mesher.pass(model.sink());
    EXPECT_EQ(after.read, during.pending);
    EXPECT_EQ(after.pending, 0u);
    expectEqualsFullRemesh(model, bone.volume, *bone.lattice);
}

TEST(Mesher, BudgetIsKeptAndEveryLeafComesAround) {
    Bone bone({40, 40, 40}, {8, 8, 8});
    Mesher mesher(bone.volume, *bone.lattice);
    Model model;
    const uint32_t leaves = bone.lattice->leafCount();
    uint32_t due = leaves;
    while (due > 0) {
        const Mesher::PassResult result = mesher.pass(model.sink(), 10);
        EXPECT_EQ(result.read, std::min(due, 10u));
        due -= result.read;
        EXPECT_EQ(result.pending, due);
    }
    expectEqualsFullRemesh(model, bone.volume, *bone.lattice);
}

TEST(Mesher, BusyLeafDoesNotStarveTheOthers) {
    Bone bone({40, 40, 40}, {8, 8, 8});
    Mesher mesher(bone.volume, *bone.lattice);
    Model model;
    // One leaf changes before every pass, and a pass does a single leaf.
    for (uint32_t n = 0; n < 2 * bone.lattice->leafCount(); ++n) {
        writeLikeTick(bone.volume, *bone.lattice, {{3, 3, 3}, {3, 3, 3}},
                      [&](int, int, int) { return Density(n); });
        mesher.pass(model.sink(), 1);
    }
    EXPECT_LE(mesher.pass(model.sink()).read, 1u);
    expectEqualsFullRemesh(model, bone.volume, *bone.lattice);
}

TEST(Mesher, IncrementalEqualsFullAfterRandomEdits) {
    for (const Eigen::Vector3i& leaf_cells :
         {Eigen::Vector3i(8, 8, 8), Eigen::Vector3i(5, 3, 9), Eigen::Vector3i(1, 1, 1)}) {
        Bone bone({30, 25, 28}, leaf_cells, 4);
        const BoneProperties properties = test::stripedProperties(bone.volume);
        Mesher mesher(bone.volume, *bone.lattice, MeshGrid::kMaxStepsPerCell, {&properties});
        Model model;
        mesher.pass(model.sink());
        std::uniform_int_distribution<int> density(0, 1);
        for (int edit = 0; edit < 40; ++edit) {
            const Density value = density(bone.random) == 0 ? Density(0) : Density(kMesherIso + 1000);
            const bool is_noise = edit % 3 == 0;
            writeLikeTick(bone.volume, *bone.lattice, test::randomBox(bone.volume, 6, bone.random),
                          [&](int, int, int) {
                              return is_noise ? Density(kMesherIso - 1 + density(bone.random)) : value;
                          });
            if (edit % 4 == 0) mesher.pass(model.sink(), 20);
        }
        while (mesher.pass(model.sink()).pending > 0) {
        }
        expectEqualsFullRemesh(model, bone.volume, *bone.lattice, &properties);
        std::vector<NodeMesh> all;
        for (const auto& [leaf, mesh] : model.meshes) all.push_back(mesh);
        EXPECT_TRUE(std::ranges::any_of(all, [](const NodeMesh& mesh) { return !mesh.materials.empty(); }));
        EXPECT_TRUE(checkMesh(all, MeshGrid(bone.volume, *bone.lattice)).isClosed());
    }
}

// This is meant for ThreadSanitizer, and is true without it as well.
TEST(Mesher, RunsBesideATickThatWrites) {
    Bone bone({40, 40, 40}, {6, 6, 6});
    Mesher mesher(bone.volume, *bone.lattice);
    Model model;
    std::atomic<bool> is_milling{true};
    std::atomic<uint32_t> passes{0};
    std::thread tick([&] {
        // There are at least so many ticks, and they go on until the mesher had a few passes in between,
        // whatever the scheduler does.
        for (int n = 0; n < 2000 || passes.load() < 20; ++n) {
            const Density value = n % 3 == 0 ? kMaxDensity : Density(n % 7 * 4000);
            writeLikeTick(bone.volume, *bone.lattice, test::randomBox(bone.volume, 5, bone.random),
                          [&](int i, int, int) { return Density(value - i); });
        }
        is_milling = false;
    });
    while (is_milling) {
        mesher.pass(model.sink(), 50);
        ++passes;
    }
    tick.join();
    while (mesher.pass(model.sink()).pending > 0) {
    }
    expectEqualsFullRemesh(model, bone.volume, *bone.lattice);
    for (const auto& [leaf, mesh] : model.meshes) EXPECT_EQ(mesh.revision, bone.lattice->version(leaf));
}

// The tick rewrites a whole leaf with one of two bodies; whatever the mesher sends must be one of them, never
// a mixture.
TEST(Mesher, NeverSendsALeafHalfWritten) {
    VoxelVolume volume(boxGeometry({16, 16, 16}), kMesherIso);
    LeafLattice lattice(volume, {32, 32, 32});
    const auto body = [](bool is_large) {
        return [is_large](int i, int j, int k) {
            const double distance = (Eigen::Vector3d(i, j, k).array() - 7.5).matrix().norm();
            return Density(std::clamp(kMesherIso + 4000 * ((is_large ? 7 : 4) - distance), 0.0, 65535.0));
        };
    };
    const IndexBox whole = test::wholeBox(volume);
    std::vector<NodeMesh> pure;
    for (const bool is_large : {false, true}) {
        writeLikeTick(volume, lattice, whole, body(is_large));
        pure.push_back(LeafMesher(volume, lattice).mesh(0).value());
    }
    ASSERT_FALSE(test::sameMesh(pure[0], pure[1]));

    Mesher mesher(volume, lattice);
    std::atomic<bool> is_enough{false};
    std::thread tick([&] {
        std::mt19937 random(3);
        std::uniform_int_distribution<int> rest_us(0, 1000);
        for (bool is_large = false; !is_enough; is_large = !is_large) {
            writeLikeTick(volume, lattice, whole, body(is_large));
            // The rests are of any length, so that writes fall into every part of the mesher's work and some
            // leave it alone.
            std::this_thread::sleep_for(std::chrono::microseconds(rest_us(random)));
        }
    });
    size_t received = 0;
    size_t mixtures = 0;
    while (received < 200) {
        mesher.pass([&](NodeMesh&& mesh) {
            ++received;
            if (!test::sameMesh(mesh, pure[0]) && !test::sameMesh(mesh, pure[1])) ++mixtures;
        });
    }
    is_enough = true;
    tick.join();
    EXPECT_EQ(mixtures, 0u);
}

}  // namespace
}  // namespace bonemill

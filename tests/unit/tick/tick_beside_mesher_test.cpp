// Tick, mesher and a consumer of node meshes at once, as in the live server: clean under ThreadSanitizer, and the
// streamed result is that of a full remesh.
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <thread>

#include "haptic_server/app/mesh_outbox.h"
#include "haptic_server/mesh/mesher.h"
#include "tests/support/scripted_io.h"
#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

TEST(TickBesideMesher, StreamedNodesEndAsTheFullRemesh) {
    BoneModel bone(test::bodyVolume(test::cubeGeometry(44, 0.125e-3), test::halfSpace({0, 0, 4e-3}, Eigen::Vector3d::UnitZ())),
                   Eigen::Vector3i::Constant(8), 1);
    const SdfGrid tool = test::sphereTool(1e-3, 0.125e-3);
    TickConfig config;
    config.milling.removal_rate = 1e9;  // few ticks move much: ThreadSanitizer slows each a hundred times
    HapticTick tick(config, bone, tool, nullptr);
    test::ScriptedIo io(test::straightPath({{2e-3, 3e-3, 4.8e-3}, Eigen::Quaterniond::Identity()}, {4.2e-3, 3e-3, 2e-3}, 150, kButtonRemove));

    MeshOutbox outbox;
    std::atomic<bool> is_milling{true};
    std::map<uint32_t, NodeMesh> shown;
    const auto consume = [&] {
        for (NodeMesh& mesh : outbox.takeAll()) shown[mesh.leaf] = std::move(mesh);
    };
    std::thread tick_thread([&] {
        while (tick.tick(io)) {}
        is_milling = false;
    });
    std::thread mesher_thread([&] {
        Mesher mesher(bone.volume, bone.lattice);
        const auto put = [&](NodeMesh&& mesh) { outbox.put(std::move(mesh)); };
        while (is_milling) mesher.pass(put, 16);
        while (mesher.pass(put).pending > 0) {}
    });
    while (is_milling) consume();
    tick_thread.join();
    mesher_thread.join();
    consume();

    size_t surfaces = 0;
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf) {
        const NodeMesh full = meshLeaf(bone.volume, bone.lattice, leaf);
        if (full.isEmpty()) {
            EXPECT_TRUE(!shown.count(leaf) || shown[leaf].isEmpty());
            continue;
        }
        ++surfaces;
        ASSERT_TRUE(shown.count(leaf));
        EXPECT_EQ(shown[leaf].revision, full.revision);
        EXPECT_TRUE(shown[leaf].vertices == full.vertices && shown[leaf].indices == full.indices) << leaf;
    }
    EXPECT_GT(surfaces, 10u);
    uint32_t removed = 0;
    for (const TickRecord& record : io.records) removed += record.removed_voxels;
    EXPECT_GT(removed, 1000u);
}

}  // namespace
}  // namespace bonemill

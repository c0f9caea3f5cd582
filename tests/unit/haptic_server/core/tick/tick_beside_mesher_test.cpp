// Tick, mesher and publisher threads run at once, as in the live server: ThreadSanitizer finds nothing, and
// what the mesher streamed is a full remesh.
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <thread>

#include "common/rt/spsc_ring.h"
#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/server/publish/publisher.h"
#include "haptic_server/surface/mesh/mesher.h"
#include "tests/support/dds_session.h"
#include "tests/support/scripted_io.h"
#include "tests/support/test_bodies.h"
#include "tests/support/typical_effects.h"

namespace bonemill {
namespace {

void expectStreamedAsRemeshed(FixedTickConfig config) {
    BoneModel bone(test::bodyVolume(test::cubeGeometry(44, 0.125e-3),
                                    test::halfSpace({0, 0, 4e-3}, Eigen::Vector3d::UnitZ())),
                   Eigen::Vector3i::Constant(8), ShellConfig{});
    const ToolModel tool = test::sphereToolModel(1e-3, 0.125e-3);
    config.tool.model = &tool;
    FixedTick tick(config, bone);
    SpscRing<TickRecord> ring(1024);
    SpscRing<Cut> cuts(1024);
    test::ScriptedIo io(test::straightPath({{2e-3, 3e-3, 4.8e-3}, Eigen::Quaterniond::Identity()},
                                           {4.2e-3, 3e-3, 2e-3}, 150, kButtonRemove));
    Publisher publisher({.domain = testDomain(), .session = testSession(), .epoch = 0});

    MeshOutbox outbox;
    MeshRounds rounds(bone.volume, bone.lattice, cuts);
    std::atomic<bool> is_milling{true};
    std::map<uint32_t, NodeMesh> shown;
    uint32_t removed = 0;
    const auto publish = [&] {
        for (NodeGroup& group : outbox.takeNearest(Eigen::Vector3f::Zero(), INT64_MAX, monotonicNowNs())) {
            EXPECT_TRUE(publisher.publishNodes(group.meshes, group.oldest_cut_ns).is_whole);
            for (NodeMesh& mesh : group.meshes)  // as the publisher: a group may hold what was overtaken
                if (!shown.count(mesh.leaf) || shown[mesh.leaf].revision < mesh.revision)
                    shown[mesh.leaf] = std::move(mesh);
        }
        TickRecord record;
        while (ring.tryPop(record)) {
            removed += record.removed_voxels;
            publisher.publishToolState(record);
        }
        publisher.publishStatus({});
    };
    std::thread tick_thread([&] {
        tick.run(io, [&](const TickRecord& record) {  // as a session
            ring.tryPush(record);
            tellMesher(cuts, record.cut);
        });
        is_milling = false;
    });
    std::thread mesher_thread([&] {
        const auto put = [&](NodeGroup&& group) { outbox.put(std::move(group), monotonicNowNs()); };
        while (is_milling) rounds.round(put);
        while (rounds.round(put) || !rounds.hasMeshedAll()) {
        }
    });
    while (is_milling) publish();
    tick_thread.join();
    mesher_thread.join();
    publish();

    LeafMesher streamed(bone.volume, bone.lattice, MeshGrid::kStreamedStepsPerCell);
    size_t surfaces = 0;
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf) {
        const NodeMesh full = streamed.mesh(leaf).value();
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
    EXPECT_EQ(publisher.digest().count(), surfaces);
    EXPECT_GT(removed, 400u);
    EXPECT_GT(rounds.cutToSink().count(), 10u);
    EXPECT_EQ(cuts.dropped(), 0u);
}

// Few ticks move much: ThreadSanitizer slows each a hundred times.
TEST(TickBesideMesherAndPublisher, StreamedNodesEndAsTheFullRemesh) {
    FixedTickConfig config;
    config.effects.time_removal = {.rate = 1e9};
    expectStreamedAsRemeshed(config);
}

TEST(TickBesideMesherAndPublisher, AlsoWhenEnergyRemoves) {
    FixedTickConfig config;
    config.tool.burr.speed = 6000;
    config.effects.energy_removal = test::kEnergyRemoval;
    config.effects.energy_removal->specific_energy = 0.02e9;
    expectStreamedAsRemeshed(config);
}

}  // namespace
}  // namespace bonemill

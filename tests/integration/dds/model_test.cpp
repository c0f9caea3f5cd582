#include <gtest/gtest.h>

#include "common/dds/remark_bounds.h"
#include "common/mesh_codec/mesh_codec.h"
#include "haptic_server/server/publish/publisher.h"
#include "tests/integration/dds/child_process.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/synthetic_nodes.h"

namespace bonemill {
namespace {

void expectSameSurface(const NodeMesh& received, const NodeMesh& published) {
    const auto decoded = decodeNodeMesh(encodeNodeMesh(published, {}).bytes, published.leaf);
    ASSERT_TRUE(decoded);
    const NodeMesh* expected = &decoded->mesh;
    EXPECT_EQ(received.revision, published.revision);
    EXPECT_EQ(received.vertices, expected->vertices);
    EXPECT_EQ(received.indices, expected->indices);
    EXPECT_EQ(received.origin, published.origin);
}

TEST(Topics, LateJoinerGetsExactlyTheCurrentModel) {
    ChildProcess server("synthetic_server");
    server.ask("nodes 0 300 2");
    server.ask("nodes 0 100 4");
    server.ask("nodes 50 10 6");
    server.ask("empty 7 6");
    server.ask("empty 299 4");
    const std::string state = server.ask("empty 298 4");

    ClientProbe client;
    ASSERT_TRUE(client.pollUntilComplete(state));
    EXPECT_EQ(client.nodes.size(), 297u);
    EXPECT_EQ(client.changes, 297u) << "no older revision, no removed node";
    for (const auto& [leaf, mesh] : client.nodes) {
        const uint32_t revision = leaf >= 100 ? 2 : leaf >= 50 && leaf < 60 ? 6 : 4;
        expectSameSurface(mesh, syntheticNode(leaf, revision));
    }
    EXPECT_FALSE(client.nodes.contains(7));
    EXPECT_TRUE(client.subscriber.hasServer());
    ASSERT_TRUE(client.pollUntil([&] { return client.subscriber.sceneInfo().has_value(); }));
    EXPECT_EQ(client.subscriber.sceneInfo()->name(), "synthetic");
    ASSERT_TRUE(client.pollUntil([&] { return client.subscriber.toolState().has_value(); }));
    EXPECT_EQ(client.subscriber.malformedSamples(), 0u);
}

TEST(Topics, ThirtyNodesAPollAddUpToTheModel) {
    ChildProcess server("synthetic_server");
    const std::string state = server.ask("nodes 0 200 2");
    ClientProbe client;
    uint32_t most_at_once = 0;
    ASSERT_TRUE(client.pollUntil([&] { return client.subscriber.status().has_value(); }));
    ASSERT_TRUE(client.pollUntil([&] {
        most_at_once = std::max(most_at_once, static_cast<uint32_t>(client.subscriber.poll(30).nodes.size()));
        return client.subscriber.isComplete();
    }));
    EXPECT_LE(most_at_once, 30u);
    EXPECT_EQ(client.digestLine(), state);
}

TEST(Topics, ChangesAndRemovalsReachWatchingAndLateClients) {
    ChildProcess server("synthetic_server");
    ClientProbe watching;
    ASSERT_TRUE(watching.pollUntilComplete(server.ask("nodes 0 20 2")));
    ASSERT_TRUE(watching.pollUntilComplete(server.ask("nodes 3 1 4")));
    ASSERT_TRUE(watching.pollUntilComplete(server.ask("empty 4 4")));
    EXPECT_FALSE(watching.nodes.contains(4));
    EXPECT_EQ(watching.nodes.at(3).revision, 4u);

    ClientProbe late;
    ASSERT_TRUE(late.pollUntilComplete(server.ask("empty 5 4")));
    EXPECT_EQ(late.nodes.size(), 18u);

    const std::string state = server.ask("nodes 4 1 6");
    ASSERT_TRUE(watching.pollUntilComplete(state));
    ASSERT_TRUE(late.pollUntilComplete(state));
    EXPECT_EQ(late.nodes.at(4).revision, 6u) << "a removed node can come back";
    EXPECT_EQ(watching.clearings + late.clearings, 0u);
}

TEST(Topics, KilledClientDisturbsNobody) {
    Publisher publisher({.domain = testDomain(), .session = testSession()});
    ChildProcess victim("synthetic_client"), survivor("synthetic_client");
    constexpr uint32_t kNodes = 50;
    for (uint32_t leaf = 0; leaf < kNodes; ++leaf)
        ASSERT_TRUE(publisher.publishNodes(std::vector{syntheticNode(leaf, 0)}).is_whole);
    ASSERT_TRUE(publisher.publishStatus({}));
    ASSERT_FALSE(victim.readLine().empty());

    for (uint32_t revision = 2; revision <= 200; revision += 2) {
        if (revision == 60) victim.kill();
        for (uint32_t leaf = 0; leaf < kNodes; ++leaf) {
            ASSERT_TRUE(publisher.publishNodes(std::vector{syntheticNode(leaf, revision)}).is_whole);
        }
        ASSERT_TRUE(publisher.publishStatus({}));
    }
    const std::string last_state =
        std::to_string(publisher.digest().count()) + ' ' + std::to_string(publisher.digest().value());
    std::string seen = survivor.readLine();
    while (!seen.empty() && seen != last_state) seen = survivor.readLine();
    EXPECT_EQ(seen, last_state);
}

TEST(Topics, LostServerLeavesTheModelAndARestartedOneReplacesIt) {
    ClientProbe client;
    EXPECT_FALSE(client.subscriber.hasServer());
    std::string first_state;
    {
        ChildProcess server("synthetic_server");
        first_state = server.ask("nodes 0 30 8");
        ASSERT_TRUE(client.pollUntilComplete(first_state));
        EXPECT_TRUE(client.subscriber.hasServer());
    }
    ASSERT_TRUE(client.pollUntil([&] { return !client.subscriber.hasServer(); }));
    EXPECT_EQ(client.digestLine(), first_state);
    EXPECT_EQ(client.nodes.size(), 30u);
    const uint64_t first_epoch = client.subscriber.epoch();

    ChildProcess restarted("synthetic_server");
    ASSERT_TRUE(client.pollUntilComplete(restarted.ask("nodes 10 5 2")));
    EXPECT_GT(client.subscriber.epoch(), first_epoch);
    EXPECT_EQ(client.clearings, 1u);
    ASSERT_EQ(client.nodes.size(), 5u);
    for (const auto& [leaf, mesh] : client.nodes) expectSameSurface(mesh, syntheticNode(leaf, 2));
    EXPECT_TRUE(client.subscriber.hasServer());
}

// A server that crashes cannot take its leave.
TEST(Topics, AnOrderlyEndIsToldFromALostServer) {
    ClientProbe client;
    int nodes = 0;
    for (const bool is_orderly : {true, false, true}) {
        ChildProcess server("synthetic_server");
        ASSERT_TRUE(client.pollUntilComplete(server.ask("nodes 0 " + std::to_string(++nodes) + " 2")));
        EXPECT_FALSE(client.subscriber.hasEnded());
        is_orderly ? server.finish() : server.kill();
        ASSERT_TRUE(client.pollUntil([&] { return !client.subscriber.hasServer(); }));
        EXPECT_EQ(client.subscriber.hasEnded(), is_orderly);
    }
}

TEST(Topics, OtherSessionsOfTheDomainAreIgnored) {
    Publisher other({.domain = testDomain(), .session = testSession() + 1});
    ASSERT_TRUE(other.publishNodes(std::vector{syntheticNode(1000, 2)}).is_whole);
    ASSERT_TRUE(other.publishStatus({}));
    ChildProcess server("synthetic_server");
    ClientProbe client;
    ASSERT_TRUE(client.pollUntilComplete(server.ask("nodes 0 5 2")));
    EXPECT_FALSE(client.nodes.contains(1000));
}

TEST(Publisher, IgnoresMeshesThatAreNotNewerAndCountsOnlyNodesWithAMesh) {
    Publisher publisher({.domain = testDomain(), .session = testSession()});
    NodeDigest expected;
    expected.add(1, encodeNodeMesh(syntheticNode(1, 6), {}).content);
    EXPECT_TRUE(publisher.publishNodes(std::vector{syntheticNode(1, 6)}).is_whole);
    EXPECT_TRUE(publisher.publishNodes(std::vector{syntheticNode(1, 4)}).is_whole);
    EXPECT_TRUE(publisher.publishNodes(std::vector{emptyNode(2, 2)}).is_whole);
    EXPECT_EQ(publisher.digest(), expected);
    EXPECT_TRUE(publisher.publishNodes(std::vector{emptyNode(1, 8)}).is_whole);
    EXPECT_TRUE(publisher.publishNodes(std::vector{syntheticNode(1, 6)}).is_whole);
    EXPECT_EQ(publisher.digest(), NodeDigest());
}

// They are published once, so a late viewer must find them, and a new run must replace them.
TEST(Structures, ComeToALateViewerAndGoWithTheirRun) {
    const uint64_t epoch = 1'700'000'000'000'000'000;
    auto first = std::make_unique<Publisher>(
        PublisherOptions{.domain = testDomain(), .session = testSession(), .epoch = epoch});
    ASSERT_TRUE(first->publishStructure(syntheticNode(2, 1), 2e-3));
    ASSERT_TRUE(first->publishStructure(syntheticNode(5, 1), 2e-3));
    ClientProbe late;
    ASSERT_TRUE(late.pollUntil([&] { return late.subscriber.structures().size() == 2; }));
    const StructureSurface& structure = late.subscriber.structures().at(2);
    EXPECT_EQ(structure.mesh.indices.size(), syntheticNode(2, 1).indices.size());
    EXPECT_EQ(structure.warning_distance, 2e-3);
    uint64_t changes = late.subscriber.structureChanges();
    ASSERT_TRUE(first->publishStructure(syntheticNode(5, 1), 1e-3));
    ASSERT_TRUE(late.pollUntil([&] { return late.subscriber.structureChanges() != changes; }));
    EXPECT_GT(late.subscriber.structures().at(5).change, changes);
    EXPECT_LE(late.subscriber.structures().at(2).change, changes) << "this one is as it was";
    changes = late.subscriber.structureChanges();
    first.reset();
    Publisher second({.domain = testDomain(), .session = testSession(), .epoch = epoch + 1});
    ASSERT_TRUE(second.publishStructure(syntheticNode(5, 1), 3e-3));
    ASSERT_TRUE(second.publishStatus({}));
    ASSERT_TRUE(late.pollUntil([&] { return late.subscriber.structures().size() == 1; }));
    EXPECT_EQ(late.subscriber.structures().at(5).warning_distance, 3e-3);
    EXPECT_NE(late.subscriber.structureChanges(), changes);
}

topics::Remark noteOf(uint32_t number) {
    topics::Remark note;
    note.set_number(number);
    note.set_note("note " + std::to_string(number));
    return note;
}

TEST(Topics, NotesReachLateClientsAndGoWithTheRun) {
    Publisher server({.domain = testDomain(), .session = testSession()});
    server.publishStatus({});
    ClientProbe watching;
    for (const uint32_t place : {0u, 1u, 2u}) server.publishRemark(place, noteOf(place + 1));
    ASSERT_TRUE(watching.pollUntil([&] { return watching.subscriber.remarks().size() == 3; }));
    server.removeRemark(1);
    server.publishRemark(2, noteOf(4));
    const auto has_both = [](const ClientProbe& client) {
        const auto& remarks = client.subscriber.remarks();
        return remarks.size() == 2 && remarks.contains(0) && remarks.contains(2) &&
               remarks.at(2).number() == 4;
    };
    ASSERT_TRUE(watching.pollUntil([&] { return has_both(watching); }));
    ClientProbe late;
    ASSERT_TRUE(late.pollUntil([&] { return has_both(late); }));

    // Another server of the session, and numbers that no server has, change nothing.
    {
        Publisher other({.domain = testDomain(), .session = testSession()});
        other.publishRemark(0, noteOf(9));
        other.removeRemark(0);
        other.publishRemark(kMaxRemarks, noteOf(5));
        ASSERT_TRUE(watching.pollUntil([&] { return watching.subscriber.malformedSamples() == 1; }));
        EXPECT_TRUE(has_both(watching));
    }

    const uint64_t changes = watching.subscriber.remarkChanges();
    server.beginRun();
    server.publishStatus({});
    server.publishRemark(0, noteOf(1));
    const auto has_one = [](const ClientProbe& client) {
        const auto& remarks = client.subscriber.remarks();
        return remarks.size() == 1 && remarks.contains(0) && remarks.at(0).number() == 1;
    };
    EXPECT_TRUE(watching.pollUntil([&] { return has_one(watching); }));
    EXPECT_GT(watching.subscriber.remarkChanges(), changes);
    ClientProbe latest;
    EXPECT_TRUE(latest.pollUntil([&] { return has_one(latest); }));
}

}  // namespace
}  // namespace bonemill

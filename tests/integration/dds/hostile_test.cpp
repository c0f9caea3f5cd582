#include <gtest/gtest.h>

#include <thread>

#include "haptic_server/publish/other_server.h"
#include "haptic_server/publish/publisher.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/synthetic_nodes.h"

namespace bonemill {
namespace {

template <class Sample>
Sample garbage(const std::string& bytes) {
    Sample sample{};
    sample.session = testSession();
    dds::setPayload(sample, bytes);
    return sample;
}

TEST(HostilePayloads, AreCountedAndDroppedByClients) {
    Publisher publisher({.domain = testDomain(), .session = testSession()});
    ASSERT_TRUE(publisher.publishNodes(std::vector{syntheticNode(1, 2)}).is_whole);
    ASSERT_TRUE(publisher.publishStatus({}));
    ClientProbe client;
    ASSERT_TRUE(client.pollUntil([&] { return client.subscriber.isComplete(); }));

    dds::Participant intruder(testDomain());
    dds::Writer<dds::NodeMeshSample> nodes(intruder);
    dds::Writer<dds::SceneInfoSample> scene_infos(intruder);
    dds::Writer<dds::StatusSample> statuses(intruder);
    dds::Writer<dds::StructureMeshSample> structures(intruder);
    const std::string bytes = "\xff\x01 this is no message";
    const std::string nothing;
    auto node = garbage<dds::NodeMeshSample>(bytes);
    for (node.node = 0; node.node < 3; ++node.node) ASSERT_TRUE(nodes.write(node));
    dds::setPayload(node, nothing);
    ASSERT_TRUE(nodes.write(node));
    ASSERT_TRUE(scene_infos.write(garbage<dds::SceneInfoSample>(bytes)));
    ASSERT_TRUE(statuses.write(garbage<dds::StatusSample>(bytes)));

    auto structure = garbage<dds::StructureMeshSample>(bytes);
    structure.structure = 1;
    ASSERT_TRUE(structures.write(structure));

    ASSERT_TRUE(client.pollUntil([&] { return client.subscriber.malformedSamples() >= 7; }));
    EXPECT_TRUE(client.subscriber.structures().empty());
    EXPECT_EQ(client.nodes.size(), 1u);
    EXPECT_TRUE(client.subscriber.isComplete());
    ASSERT_TRUE(publisher.publishNodes(std::vector{syntheticNode(1, 4)}).is_whole);
    ASSERT_TRUE(publisher.publishStatus({}));
    EXPECT_TRUE(
        client.pollUntil([&] { return client.subscriber.isComplete() && client.nodes.at(1).revision == 4; }));
}

TEST(OtherServer, IsFoundBySessionAndOnlyWhileItLives) {
    using std::chrono::milliseconds;
    const dds::Participant late(testDomain());
    const uint32_t session = testSession();
    EXPECT_FALSE(findOtherServer(late, session, milliseconds(100)));
    {
        Publisher first({.domain = testDomain(), .session = session, .epoch = 1'700'000'000'000'000'000});
        topics::Status status;
        status.set_scene("tooth\ncorridor");
        ASSERT_TRUE(first.publishStatus(status));
        const auto found = findOtherServer(late, session, milliseconds(5000));
        ASSERT_TRUE(found);
        EXPECT_EQ(found->scene, "tooth?corridor");
        EXPECT_EQ(found->epoch_ns, 1'700'000'000'000'000'000u);
        const std::string text = refusalText(*found, testDomain(), session);
        EXPECT_NE(text.find("since 2023-11-1"), std::string::npos) << text;
        EXPECT_NE(text.find("--session"), std::string::npos) << text;
        EXPECT_FALSE(findOtherServer(late, session + 1, milliseconds(300)));
    }
    EXPECT_FALSE(findOtherServer(late, session, milliseconds(300)));
}

TEST(HostilePayloads, AreCountedAndDroppedByTheServer) {
    Publisher publisher({.domain = testDomain(), .session = testSession()});
    dds::Participant intruder(testDomain());
    dds::Writer<dds::CommandSample> commands(intruder);
    const std::string bytes = "\xff\x01 this is no message";
    auto sample = garbage<dds::CommandSample>(bytes);
    sample.sender = 5;
    for (int i = 0; i < 1000 && publisher.malformedCommands() == 0; ++i) {
        ASSERT_TRUE(commands.write(sample));  // again and again: the first ones precede the match
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        EXPECT_TRUE(publisher.takeCommands().empty());
    }
    EXPECT_GT(publisher.malformedCommands(), 0u);
}

}  // namespace
}  // namespace bonemill

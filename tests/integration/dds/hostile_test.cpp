#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <memory>
#include <thread>

#include "common/mesh_codec/mesh_codec.h"
#include "haptic_server/server/publish/other_server.h"
#include "haptic_server/server/publish/publisher.h"
#include "tests/integration/dds/child_process.h"
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

// Nodes of a stranger who says that it is the server.
class Forger {
  public:
    void write(uint32_t leaf, uint64_t epoch) {
        const std::string bytes = encodeNodeMesh(syntheticNode(leaf, 7), {.epoch = epoch}).bytes;
        auto sample = garbage<dds::NodeMeshSample>(bytes);
        sample.node = leaf;
        sample.revision = 7;
        EXPECT_TRUE(nodes_.write(sample));
    }
    void remove(uint32_t leaf) {
        dds::NodeMeshSample key{};
        key.session = testSession();
        key.node = leaf;
        EXPECT_TRUE(nodes_.dispose(key));
    }

  private:
    dds::Participant participant_{testDomain()};
    dds::Writer<dds::NodeMeshSample> nodes_{participant_};
};

TEST(HostilePayloads, ForgedNodesBlankNoViewerNotEvenOverARestart) {
    constexpr uint64_t kEpoch = 1'700'000'000'000'000'000;
    auto server = std::make_unique<Publisher>(
        PublisherOptions{.domain = testDomain(), .session = testSession(), .epoch = kEpoch});
    ASSERT_TRUE(server->publishNodes(std::vector{syntheticNode(1, 2)}).is_whole);
    ASSERT_TRUE(server->publishStatus({}));
    ClientProbe client;
    ASSERT_TRUE(client.pollUntil([&] { return client.subscriber.isComplete(); }));

    Forger forger;
    const auto forge = [&] {
        forger.write(1, UINT64_MAX);
        forger.write(2, kEpoch);
        forger.remove(1);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        client.poll();
    };
    for (int n = 0; n < 20; ++n) forge();
    EXPECT_EQ(client.subscriber.epoch(), kEpoch);
    EXPECT_EQ(client.nodes.size(), 1u);
    EXPECT_TRUE(client.nodes.contains(1));
    server.reset();
    for (int n = 0; n < 20; ++n) forge();
    EXPECT_EQ(client.clearings, 0u) << "what was there last is shown on";

    server = std::make_unique<Publisher>(
        PublisherOptions{.domain = testDomain(), .session = testSession(), .epoch = kEpoch + 1});
    ASSERT_TRUE(server->publishNodes(std::vector{syntheticNode(3, 2)}).is_whole);
    ASSERT_TRUE(server->publishStatus({}));
    ASSERT_TRUE(client.pollUntil(
        [&] { return client.subscriber.epoch() == kEpoch + 1 && client.subscriber.isComplete(); }));
    EXPECT_EQ(client.clearings, 1u);
    EXPECT_TRUE(client.nodes.contains(3));
}

TEST(HostilePayloads, AForgedStatusSilencesNoClient) {
    Publisher server({.domain = testDomain(), .session = testSession()});
    ClientProbe client;
    const auto statusIsThere = [&] { return client.subscriber.status().has_value(); };
    ASSERT_TRUE(server.publishStatus({}));
    ASSERT_TRUE(client.pollUntil(statusIsThere));
    topics::Command command;
    command.set_save_checkpoint(true);
    const uint32_t first = client.subscriber.sendCommand(command);
    topics::Command heard;
    ASSERT_TRUE(client.pollUntil([&] {
        for (const topics::Command& c : server.takeCommands()) heard = c;
        return heard.sequence() == first;
    }));
    dds::Participant intruder(testDomain());
    dds::Writer<dds::StatusSample> statuses(intruder);
    topics::Status forged;
    forged.set_epoch(server.epoch());
    forged.set_last_command_sender(heard.sender());
    for (const uint32_t sequence : {first, UINT32_MAX}) {
        forged.set_last_command_sequence(sequence);
        forged.set_last_command_result("done");
        forged.set_last_command_outcome(topics::DONE);
        const std::string bytes = forged.SerializeAsString();
        for (int n = 0; n < 10; ++n) {
            ASSERT_TRUE(statuses.write(garbage<dds::StatusSample>(bytes)));
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            client.poll();
        }
    }
    EXPECT_TRUE(client.subscriber.takeOutcomes().empty()) << "a stranger cannot say how it ended";
    server.acknowledge(heard, Answer::refused("no"));
    std::vector<CommandOutcome> outcomes;
    ASSERT_TRUE(client.pollUntil([&] {
        outcomes = client.subscriber.takeOutcomes();
        return !outcomes.empty();
    }));
    EXPECT_EQ(outcomes[0].answer.text, "refused: no");
}

TEST(HostilePayloads, AForgedCommandSilencesNoClient) {
    Publisher server({.domain = testDomain(), .session = testSession()});
    ClientProbe client;
    topics::Command command;
    command.set_save_checkpoint(true);
    std::vector<topics::Command> heard;
    const auto hears = [&] {
        EXPECT_TRUE(server.publishStatus({}));
        for (const topics::Command& one : server.takeCommands()) {
            heard.push_back(one);
            server.acknowledge(one, Answer::done());
        }
    };
    client.subscriber.sendCommand(command);
    ASSERT_TRUE(client.pollUntil([&] { return hears(), !client.subscriber.takeOutcomes().empty(); }));
    ASSERT_EQ(heard.size(), 1u);

    const dds::Participant intruder(testDomain());
    dds::Writer<dds::CommandSample> commands(intruder);
    topics::Command forged = heard[0];
    forged.set_sequence(UINT32_MAX);
    const std::string bytes = forged.SerializeAsString();
    auto sample = garbage<dds::CommandSample>(bytes);
    sample.sender = forged.sender();
    ASSERT_TRUE(client.pollUntil([&] { return commands.matchedReaders() > 0; }));
    for (int n = 0; n < 10; ++n) {
        ASSERT_TRUE(commands.write(sample));
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        hears();
    }
    client.subscriber.sendCommand(command);
    EXPECT_TRUE(client.pollUntil([&] { return hears(), !client.subscriber.takeOutcomes().empty(); }));
    ASSERT_EQ(heard.size(), 2u) << "only the client's own are carried out";
    EXPECT_EQ(heard[1].sequence(), 2u);
}

TEST(Deafness, AViewerThatHearsNothingJoinsAnew) {
    using std::chrono::milliseconds;
    SceneSubscriber viewer(
        {.domain = testDomain(), .session = testSession(), .rejoin_after = milliseconds(100)});
    const auto end = std::chrono::steady_clock::now() + milliseconds(1000);
    while (std::chrono::steady_clock::now() < end) {
        viewer.poll();
        viewer.waitForData(milliseconds(10));
    }
    EXPECT_GE(viewer.rejoinings(), 2u);
    EXPECT_LE(viewer.rejoinings(), 3u) << "after 100, 300, 700 ms";
    Publisher server({.domain = testDomain(), .session = testSession()});
    const auto isHeard = [&] {
        viewer.poll();
        viewer.waitForData(milliseconds(10));
        return server.publishStatus({}) && viewer.hasServer();
    };
    for (int n = 0; n < 1000 && !isHeard(); ++n) {
    }
    ASSERT_TRUE(viewer.hasServer());
    const uint64_t rejoinings = viewer.rejoinings();
    topics::Command command;
    command.set_save_checkpoint(true);
    viewer.sendCommand(command);
    bool has_heard = false;
    for (int n = 0; n < 1000 && !has_heard; ++n) {
        EXPECT_TRUE(isHeard());
        has_heard = !server.takeCommands().empty();
    }
    EXPECT_TRUE(has_heard);
    for (int n = 0; n < 30; ++n) EXPECT_TRUE(isHeard());
    EXPECT_EQ(viewer.rejoinings(), rejoinings) << "a server is heard";
}

// Returns how often a viewer joins anew while a server tells this status, another tick each time, for a
// second.
uint64_t rejoiningsWhile(topics::Status status, bool tells_tool) {
    using std::chrono::milliseconds;
    Publisher server({.domain = testDomain(), .session = testSession()});
    SceneSubscriber viewer(
        {.domain = testDomain(), .session = testSession(), .rejoin_after = milliseconds(200)});
    TickRecord record{};
    record.q_WT[0] = record.q_WT_device[0] = 1;
    const auto poll = [&] {
        viewer.poll();
        viewer.waitForData(milliseconds(10));
    };
    const auto tell = [&] {
        status.set_ticks(++record.tick);
        server.publishStatus(status);
        if (tells_tool) server.publishToolState(record, {});
    };
    for (int n = 0; n < 1000 && !viewer.hasServer(); ++n) tell(), poll();
    EXPECT_TRUE(viewer.hasServer());
    const uint64_t before = viewer.rejoinings();
    const auto end = std::chrono::steady_clock::now() + milliseconds(1000);
    while (std::chrono::steady_clock::now() < end) tell(), poll();
    return viewer.rejoinings() - before;
}

TEST(Deafness, AViewerThatMissesWhatTheServerGoesOnTellingJoinsAnew) {
    topics::Status partial;
    partial.set_is_model_partial(true);
    EXPECT_EQ(rejoiningsWhile({}, true), 0u) << "nothing is missing";
    EXPECT_GE(rejoiningsWhile({}, false), 1u) << "it ticks, and no tool is heard";
    EXPECT_GE(rejoiningsWhile(partial, true), 1u) << "a node is missing, and none comes";
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

size_t residentBytes() {
    size_t total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return resident * size_t(sysconf(_SC_PAGESIZE));
}

// DDS keeps a key for as long as its writer lives.
TEST(HostileSenders, TakeNoMemoryAndHonestOnesAreHeard) {
    Publisher publisher({.domain = testDomain(), .session = testSession()});
    ChildProcess intruder("synthetic_intruder", "commands");
    const size_t before = residentBytes();
    std::atomic<bool> is_done = false;
    std::thread asking([&] {
        EXPECT_EQ(intruder.ask("100000"), "done");
        is_done = true;
    });
    while (!is_done) publisher.takeCommands();
    asking.join();
    publisher.takeCommands();
    EXPECT_GT(publisher.malformedCommands(), 10'000u);
    EXPECT_LT(double(residentBytes()) - double(before), 25e6);

    ClientProbe client;
    topics::Command pause;
    pause.set_pause_milling(true);
    client.subscriber.sendCommand(pause);
    EXPECT_TRUE(client.pollUntil([&] { return !publisher.takeCommands().empty(); }));
}

// They stay, and so do their keys: who comes later is heard all the same.
TEST(HostileSenders, KeepOutNoViewer) {
    Publisher publisher({.domain = testDomain(), .session = testSession()});
    ASSERT_TRUE(publisher.publishStatus({}));
    ClientProbe watching;
    ASSERT_TRUE(watching.pollUntil([&] { return watching.subscriber.hasServer(); }));
    ChildProcess intruder("synthetic_intruder", "viewers");
    EXPECT_EQ(intruder.ask("5000"), "done");
    watching.poll();
    ClientProbe honest;
    EXPECT_TRUE(watching.pollUntil([&] {
        honest.poll();
        honest.subscriber.announce(60, std::nullopt);
        return watching.subscriber.viewers().size() == 1;
    }));
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

// A viewer behind a gateway is a viewer as any other.
#include <gtest/gtest.h>

#include "common/user_error.h"
#include "render_client/connect/gateway_session.h"
#include "render_client/subscribe/command_words.h"
#include "render_client/subscribe/scene_subscriber.h"
#include "tests/integration/gateway/gateway_guest.h"

namespace bonemill::gateway {
namespace {

struct RemoteViewer {
    std::shared_ptr<connect::GatewaySession> session;
    SceneSubscriber subscriber;
    std::map<uint32_t, uint32_t> nodes;  // leaves and revisions
    std::vector<CommandOutcome> outcomes;

    RemoteViewer(const RunningGateway& gateway, const std::string& token)
        : session(
              std::make_shared<connect::GatewaySession>(gateway.target(), token, std::chrono::seconds(5))),
          subscriber(
              {.name = session->welcome().name(), .role = session->welcome().role(), .remote = session}) {}

    template <class Condition>
    bool pollUntil(Condition&& condition) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (true) {
            const SceneModel::Changes changes = subscriber.poll();
            if (changes.is_cleared) nodes.clear();
            for (const SceneModel::Change& change : changes.nodes) {
                nodes[change.mesh.leaf] = change.mesh.revision;
                if (change.mesh.isEmpty()) nodes.erase(change.mesh.leaf);
            }
            for (const CommandOutcome& outcome : subscriber.takeOutcomes()) outcomes.push_back(outcome);
            if (condition()) return true;
            if (std::chrono::steady_clock::now() > end) return false;
            subscriber.waitForData(std::chrono::milliseconds(20));
        }
    }
    bool pollUntilComplete(const NodeDigest& digest) {
        return pollUntil([&] { return subscriber.isComplete() && subscriber.digest() == digest; });
    }
};

TEST(RemoteViewer, ShowsTheModelAndCommands) {
    TestServer server(60);
    const RunningGateway gateway(invitationOf("Anna", "OPERATOR", "anna") +
                                 invitationOf("Observer", "VIEWER", "observer"));
    RemoteViewer anna(gateway, "anna"), observer(gateway, "observer");
    EXPECT_EQ(anna.session->welcome().role(), topics::Viewer::OPERATOR);
    ASSERT_TRUE(anna.pollUntilComplete(server.publisher.digest()));
    EXPECT_TRUE(anna.subscriber.hasServer());
    EXPECT_TRUE(anna.subscriber.sceneInfo());
    server.show({syntheticNode(3, 2), emptyNode(5, 2)});
    ASSERT_TRUE(anna.pollUntilComplete(server.publisher.digest()));
    EXPECT_EQ(anna.nodes.size(), 59u);
    EXPECT_EQ(anna.nodes[3], 2u);

    topics::Command reset;
    reset.set_reset_volume(true);
    anna.subscriber.sendCommand(reset);
    ASSERT_TRUE(anna.pollUntil([&] {
        for (const topics::Command& command : server.publisher.takeCommands()) {
            EXPECT_EQ(command.sender(), anna.session->welcome().sender());
            EXPECT_EQ(command.name(), "Anna");
            server.publisher.acknowledge(command, "done");
        }
        return !anna.outcomes.empty();
    }));
    EXPECT_TRUE(anna.outcomes[0].isDone());
    observer.subscriber.sendCommand(reset);
    ASSERT_TRUE(observer.pollUntil([&] { return !observer.outcomes.empty(); }));
    EXPECT_EQ(observer.outcomes[0].result, "refused: an observer only looks");

    anna.subscriber.announce(60, std::nullopt);
    ASSERT_TRUE(observer.pollUntil([&] { return observer.subscriber.viewers().size() == 1; }));
    EXPECT_EQ(observer.subscriber.viewers()[0].name(), "Anna");
    EXPECT_EQ(observer.subscriber.viewers()[0].link(), "viewer");
    anna.pollUntil([] { return true; });
    EXPECT_TRUE(anna.subscriber.viewers().empty()) << "nobody but itself";
}

TEST(RemoteViewer, FindsTheGatewayAgainAndHasWhatChangedMeanwhile) {
    TestServer server(60);
    RunningGateway gateway(invitationOf("Anna", "VIEWER", "anna"));
    RemoteViewer anna(gateway, "anna");
    ASSERT_TRUE(anna.pollUntilComplete(server.publisher.digest()));
    gateway.stop();
    ASSERT_TRUE(anna.pollUntil([&] { return !anna.subscriber.hasServer(); }));
    EXPECT_FALSE(anna.subscriber.hasEnded()) << "the way is lost, not the server";
    server.show({syntheticNode(3, 2), emptyNode(5, 2), syntheticNode(80, 1)});
    gateway.start();
    ASSERT_TRUE(anna.pollUntil([&] {
        server.tellStatus();
        return anna.subscriber.isComplete() && anna.subscriber.digest() == server.publisher.digest();
    }));
    EXPECT_EQ(anna.nodes.size(), 60u);
    EXPECT_TRUE(anna.subscriber.hasServer());
}

TEST(RemoteViewer, IsToldWhyItMayNotCome) {
    const RunningGateway gateway(invitationOf("Anna", "VIEWER", "anna"));
    try {
        RemoteViewer stranger(gateway, "wrong");
        ADD_FAILURE() << "came in";
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("Ask for a new invitation"), std::string::npos)
            << error.what();
        EXPECT_EQ(std::string(error.what()).find("wrong"), std::string::npos);
    }
}

}  // namespace
}  // namespace bonemill::gateway

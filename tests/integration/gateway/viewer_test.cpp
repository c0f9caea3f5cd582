// A viewer behind a gateway is a viewer as any other.
#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "render_client/link/subscribe/command_words.h"
#include "tests/integration/gateway/gateway_guest.h"
#include "tests/integration/gateway/remote_viewer.h"

namespace bonemill::gateway {
namespace {

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
            server.publisher.acknowledge(command, Answer::done());
        }
        return !anna.outcomes.empty();
    }));
    EXPECT_TRUE(anna.outcomes[0].isDone());
    observer.subscriber.sendCommand(reset);
    ASSERT_TRUE(observer.pollUntil([&] { return !observer.outcomes.empty(); }));
    EXPECT_EQ(observer.outcomes[0].answer.outcome, topics::REFUSED);

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

TEST(RemoteViewer, ItsTokenLeavesTheProcessList) {
    const std::string token = "00112233445566778899aabbccddeeff";
    TestServer server(3);  // which answers no order
    const RunningGateway gateway(invitationOf("Anna", "OPERATOR", token));
    test::Process viewer({"render_client", "--connect",
                          "https://127.0.0.1:" + std::to_string(gateway.target().port) + "/#" + token,
                          "--fingerprint", gateway.target().fingerprint, "--command", "pause"});
    const auto command_line = [&] {
        return test::readFile("/proc/" + std::to_string(viewer.pid()) + "/cmdline");
    };
    EXPECT_TRUE(test::waitFor([&] { return viewer.errSoFar().find("warning") != std::string::npos; }));
    EXPECT_TRUE(test::waitFor(
        [&] { return !viewer.isRunning() || command_line().find(token) == std::string::npos; }));
    ASSERT_TRUE(viewer.isRunning()) << viewer.errSoFar();
    EXPECT_NE(command_line().find("/#" + std::string(token.size(), 'x')), std::string::npos);
    EXPECT_EQ(viewer.wait().err.find(token), std::string::npos);
}

}  // namespace
}  // namespace bonemill::gateway

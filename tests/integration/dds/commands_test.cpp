#include <gtest/gtest.h>

#include "tests/integration/dds/child_process.h"
#include "tests/integration/dds/client_probe.h"

namespace bonemill {
namespace {

topics::Command pauseCommand() {
    topics::Command command;
    command.set_pause_milling(true);
    return command;
}

std::vector<CommandOutcome> pollForOutcomes(ClientProbe& client, size_t count) {
    std::vector<CommandOutcome> outcomes;
    client.pollUntil([&] {
        for (CommandOutcome& outcome : client.subscriber.takeOutcomes())
            outcomes.push_back(std::move(outcome));
        return outcomes.size() >= count;
    });
    return outcomes;
}

TEST(Commands, AreAcknowledgedInOrder) {
    ChildProcess server("synthetic_server");
    ClientProbe client;
    topics::Command reset;
    reset.set_reset_volume(true);
    const uint32_t first = client.subscriber.sendCommand(pauseCommand());
    const uint32_t second = client.subscriber.sendCommand(reset);
    const auto outcomes = pollForOutcomes(client, 2);
    ASSERT_EQ(outcomes.size(), 2u);
    EXPECT_EQ(outcomes[0].sequence, first);
    EXPECT_TRUE(outcomes[0].is_acknowledged) << outcomes[0].answer.text;
    EXPECT_EQ(outcomes[0].answer.text, "done: action " + std::to_string(topics::Command::kPauseMilling));
    EXPECT_EQ(outcomes[1].sequence, second);
    EXPECT_EQ(outcomes[1].answer.text, "done: action " + std::to_string(topics::Command::kResetVolume));
}

TEST(Commands, UnknownActionIsRefusedWithAReason) {
    ChildProcess server("synthetic_server");
    ClientProbe client;
    client.subscriber.sendCommand({});
    const auto outcomes = pollForOutcomes(client, 1);
    ASSERT_EQ(outcomes.size(), 1u);
    EXPECT_TRUE(outcomes[0].is_acknowledged);
    EXPECT_NE(outcomes[0].answer.text.find("refused"), std::string::npos) << outcomes[0].answer.text;
}

TEST(Commands, OfSeveralClientsAreAllAcknowledged) {
    ChildProcess server("synthetic_server");
    ClientProbe clients[4];
    for (ClientProbe& client : clients) client.subscriber.sendCommand(pauseCommand());
    for (ClientProbe& client : clients) {
        const auto outcomes = pollForOutcomes(client, 1);
        ASSERT_EQ(outcomes.size(), 1u);
        EXPECT_TRUE(outcomes[0].is_acknowledged) << outcomes[0].answer.text;
    }
}

TEST(Commands, WithoutAServerGiveUp) {
    ClientProbe client;
    client.subscriber.sendCommand(pauseCommand());
    const auto outcomes = pollForOutcomes(client, 1);
    ASSERT_EQ(outcomes.size(), 1u);
    EXPECT_FALSE(outcomes[0].is_acknowledged);
    EXPECT_EQ(outcomes[0].answer.text, "no server");
}

}  // namespace
}  // namespace bonemill

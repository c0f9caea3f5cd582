#include <gtest/gtest.h>

#include "render_client/link/subscribe/viewer_voice.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr uint64_t kSender = 77;

class CommandOutboxTest : public testing::Test {
  protected:
    void stepAt(std::chrono::milliseconds time, bool is_connected = true) {
        outbox_.step(CommandOutbox::Clock::time_point(time), is_connected,
                     [this](const topics::Command& command) { written_.push_back(command); });
    }
    static topics::Status acknowledgement(uint64_t sender, uint32_t sequence) {
        topics::Status status;
        status.set_last_command_sender(sender);
        status.set_last_command_sequence(sequence);
        status.set_last_command_result("done");
        status.set_last_command_outcome(topics::DONE);
        return status;
    }

    CommandOutbox outbox_{kSender};
    std::vector<topics::Command> written_;
};

TEST_F(CommandOutboxTest, WritesOnceUntilItIsTimeToRepeat) {
    topics::Command command;
    command.set_pause_milling(true);
    EXPECT_EQ(outbox_.enqueue(command), 1u);
    stepAt(0ms);
    stepAt(499ms);
    ASSERT_EQ(written_.size(), 1u);
    EXPECT_EQ(written_[0].sender(), kSender);
    EXPECT_EQ(written_[0].sequence(), 1u);
    EXPECT_TRUE(written_[0].pause_milling());
    stepAt(500ms);
    ASSERT_EQ(written_.size(), 2u);
    EXPECT_EQ(written_[1].sequence(), 1u) << "a repetition, not a new command";
}

TEST_F(CommandOutboxTest, OneCommandAfterTheOther) {
    outbox_.enqueue({});
    outbox_.enqueue({});
    stepAt(0ms);
    stepAt(1ms);
    ASSERT_EQ(written_.size(), 1u);
    outbox_.acknowledge(acknowledgement(kSender, 1));
    stepAt(2ms);
    ASSERT_EQ(written_.size(), 2u);
    EXPECT_EQ(written_[1].sequence(), 2u);
    const auto outcomes = outbox_.takeOutcomes();
    ASSERT_EQ(outcomes.size(), 1u);
    EXPECT_TRUE(outcomes[0].is_acknowledged);
    EXPECT_TRUE(outcomes[0].isDone());
    EXPECT_EQ(outcomes[0].answer.text, "done");
}

TEST_F(CommandOutboxTest, AnOutcomeNamesItsCommand) {
    topics::Command accuracy, reset;
    accuracy.set_set_accuracy("best");
    reset.set_reset_volume(true);
    outbox_.enqueue(accuracy);
    outbox_.enqueue(reset);
    stepAt(0ms);
    topics::Status refusal = acknowledgement(kSender, 1);
    refusal.set_last_command_result("refused: no such preset");
    refusal.set_last_command_outcome(topics::REFUSED);
    outbox_.acknowledge(refusal);
    stepAt(1ms);
    stepAt(5001ms);
    const auto outcomes = outbox_.takeOutcomes();
    ASSERT_EQ(outcomes.size(), 2u);
    EXPECT_FALSE(outcomes[0].isDone());
    EXPECT_EQ(outcomeText(outcomes[0]), "accuracy best: refused: no such preset");
    EXPECT_FALSE(outcomes[1].isDone());
    EXPECT_EQ(outcomeText(outcomes[1]), "put the bone back: the server did not answer");
}

TEST_F(CommandOutboxTest, AnEmptyResultIsNoSuccess) {
    topics::Command reset;
    reset.set_reset_volume(true);
    outbox_.enqueue(reset);
    stepAt(0ms);
    topics::Status status = acknowledgement(kSender, 1);
    status.clear_last_command_result();
    status.clear_last_command_outcome();
    outbox_.acknowledge(status);
    const auto outcomes = outbox_.takeOutcomes();
    ASSERT_EQ(outcomes.size(), 1u);
    EXPECT_FALSE(outcomes[0].isDone());
    EXPECT_EQ(outcomeText(outcomes[0]), "put the bone back: the server gave no result");
}

TEST_F(CommandOutboxTest, OtherAcknowledgementsDoNotCount) {
    outbox_.enqueue({});
    stepAt(0ms);
    outbox_.acknowledge(acknowledgement(kSender + 1, 1));
    outbox_.acknowledge(acknowledgement(kSender, 2));
    outbox_.acknowledge(topics::Status());
    EXPECT_TRUE(outbox_.takeOutcomes().empty());
}

TEST_F(CommandOutboxTest, WaitsForAServerAndGivesUp) {
    outbox_.enqueue({});
    stepAt(0ms, false);
    stepAt(4999ms, false);
    EXPECT_TRUE(written_.empty());
    EXPECT_TRUE(outbox_.takeOutcomes().empty());
    stepAt(5000ms, false);
    const auto outcomes = outbox_.takeOutcomes();
    ASSERT_EQ(outcomes.size(), 1u);
    EXPECT_FALSE(outcomes[0].is_acknowledged);
    EXPECT_EQ(outcomes[0].answer.text, "no server");
}

TEST_F(CommandOutboxTest, EachCommandHasItsOwnTimeout) {
    outbox_.enqueue({});
    outbox_.enqueue({});
    stepAt(0ms);
    stepAt(5000ms);
    stepAt(5001ms);
    ASSERT_EQ(outbox_.takeOutcomes().size(), 1u);
    stepAt(10000ms);
    EXPECT_TRUE(outbox_.takeOutcomes().empty());
    stepAt(10001ms);
    EXPECT_EQ(outbox_.takeOutcomes().at(0).answer.text, "the server did not answer");
}

}  // namespace
}  // namespace bonemill

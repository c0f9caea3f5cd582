#include "haptic_server/server/publish/command_inbox.h"

#include <gtest/gtest.h>

#include <set>

namespace bonemill {
namespace {

topics::Command resetCommand(uint64_t sender, uint32_t sequence) {
    topics::Command command;
    command.set_sender(sender);
    command.set_sequence(sequence);
    command.set_reset_volume(true);
    return command;
}

class CommandInboxTest : public testing::Test {
  protected:
    CommandInbox::Decision receive(uint64_t envelope_sender, const topics::Command& command,
                                   const CommandOrigin& origin = kAnna) {
        return receiveBytes(envelope_sender, command.SerializeAsString(), origin);
    }
    CommandInbox::Decision receiveBytes(uint64_t envelope_sender, const std::string& bytes,
                                        const CommandOrigin& origin = kAnna) {
        return inbox_.receive(envelope_sender, origin,
                              {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    }

    static constexpr CommandOrigin kAnna{1, 11}, kOtto{2, 22};
    std::set<uint64_t> gone_;  // writers
    CommandInbox inbox_{[this](uint64_t writer) { return !gone_.contains(writer); }};
};

TEST_F(CommandInboxTest, CarriesACommandOutOnceAndAcknowledgesRepetitions) {
    const auto first = receive(7, resetCommand(7, 1));
    ASSERT_TRUE(first.command);
    EXPECT_TRUE(first.command->reset_volume());

    const auto repeated_before_the_end = receive(7, resetCommand(7, 1));
    EXPECT_FALSE(repeated_before_the_end.command);
    EXPECT_FALSE(repeated_before_the_end.acknowledgement);

    inbox_.finish(*first.command, Answer::done());
    const auto repeated = receive(7, resetCommand(7, 1));
    EXPECT_FALSE(repeated.command);
    ASSERT_TRUE(repeated.acknowledgement);
    EXPECT_EQ(repeated.acknowledgement->sender, 7u);
    EXPECT_EQ(repeated.acknowledgement->sequence, 1u);
    EXPECT_EQ(repeated.acknowledgement->answer.text, "done");
}

// Who repeats a command reads what who did not repeat it has read.
TEST_F(CommandInboxTest, ARepetitionIsAnsweredWithTheVeryResult) {
    for (const Answer& answer : {Answer::done(), Answer::refused("no"), Answer()}) {
        inbox_ = CommandInbox([](uint64_t) { return true; });
        const auto first = receive(7, resetCommand(7, 1));
        ASSERT_TRUE(first.command);
        EXPECT_EQ(inbox_.finish(*first.command, answer).answer.text, answer.text);
        const auto repeated = receive(7, resetCommand(7, 1));
        ASSERT_TRUE(repeated.acknowledgement) << "'" << answer.text << "'";
        EXPECT_EQ(repeated.acknowledgement->answer.text, answer.text);
        EXPECT_EQ(repeated.acknowledgement->answer.outcome, answer.outcome);
    }
}

TEST_F(CommandInboxTest, IgnoresOlderSequences) {
    ASSERT_TRUE(receive(7, resetCommand(7, 5)).command);
    const auto older = receive(7, resetCommand(7, 4));
    EXPECT_FALSE(older.command);
    EXPECT_FALSE(older.acknowledgement);
}

TEST_F(CommandInboxTest, SendersDoNotDisturbEachOther) {
    EXPECT_TRUE(receive(7, resetCommand(7, 5)).command);
    EXPECT_TRUE(receive(8, resetCommand(8, 1)).command);
    EXPECT_TRUE(receive(7, resetCommand(7, 6)).command);
}

TEST_F(CommandInboxTest, AnswersAnUnknownAction) {
    topics::Command command = resetCommand(7, 1);
    command.clear_action();
    const auto decision = receive(7, command);
    EXPECT_FALSE(decision.command);
    ASSERT_TRUE(decision.acknowledgement);
    EXPECT_NE(decision.acknowledgement->answer.text.find("refused"), std::string::npos);
    EXPECT_TRUE(receive(7, command).acknowledgement) << "a repetition is answered too";
    EXPECT_EQ(inbox_.malformedCount(), 0u);
}

TEST_F(CommandInboxTest, CountsAndDropsWhatIsNoCommandOfThatSender) {
    const auto is_dropped = [](const CommandInbox::Decision& d) { return !d.command && !d.acknowledgement; };
    EXPECT_TRUE(is_dropped(receiveBytes(7, "\xff\xff\xff not a command")));
    EXPECT_TRUE(is_dropped(receiveBytes(7, "")));
    EXPECT_TRUE(is_dropped(receive(7, resetCommand(8, 1))));
    EXPECT_TRUE(is_dropped(receive(7, resetCommand(7, 0))));
    EXPECT_EQ(inbox_.malformedCount(), 4u);
    EXPECT_TRUE(receive(7, resetCommand(7, 1)).command);
}

// Nothing that is said in a command needs more; what it says may be kept per sender.
TEST_F(CommandInboxTest, LongPayloadsAreMalformed) {
    const auto ofLength = [](size_t length) {
        topics::Command command = resetCommand(7, 1);
        command.set_set_accuracy(std::string(length, 'a'));
        return command;
    };
    constexpr size_t kLongest = 4096;
    size_t length = kLongest;
    while (ofLength(length).ByteSizeLong() > kLongest) --length;
    EXPECT_FALSE(receive(7, ofLength(length + 1)).command);
    EXPECT_FALSE(receive(7, ofLength(10'000'000)).command);
    EXPECT_EQ(inbox_.malformedCount(), 2u);
    EXPECT_TRUE(receive(7, ofLength(length)).command);
    EXPECT_EQ(inbox_.malformedCount(), 2u);
}

// A hostile sender must not fill the log: who takes commands says so once.
TEST_F(CommandInboxTest, MalformedTextsAreNotLogged) {
    topics::Command command;
    command.set_sender(7);
    command.set_sequence(1);
    command.set_export_("name");
    std::string bytes = command.SerializeAsString();
    bytes.replace(bytes.find("name"), 4, "\xff\xfe\xff\xfe");
    testing::internal::CaptureStderr();
    for (int n = 0; n < 3; ++n) EXPECT_FALSE(receiveBytes(7, bytes).command);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(inbox_.malformedCount(), 3u);
}

TEST_F(CommandInboxTest, AForgedNumberSilencesNobody) {
    ASSERT_TRUE(receive(7, resetCommand(7, 1)).command);
    const auto forged = receive(7, resetCommand(7, UINT32_MAX), kOtto);
    EXPECT_FALSE(forged.command);
    EXPECT_TRUE(forged.is_foreign);
    EXPECT_FALSE(forged.acknowledgement) << "the first would read it, if it came to this number";
    EXPECT_TRUE(receive(7, resetCommand(7, 2)).command);
    EXPECT_TRUE(receive(7, resetCommand(7, 3), {kAnna.participant, 12}).command) << "another of its writers";
    const auto newcomer = receive(7, resetCommand(7, 1), kOtto);
    EXPECT_FALSE(newcomer.command);
    ASSERT_TRUE(newcomer.acknowledgement);
    EXPECT_NE(newcomer.acknowledgement->answer.text.find("refused: another client"), std::string::npos);
}

TEST_F(CommandInboxTest, WhoJoinsAnewGoesOnAndWhoTakesTheNumberOfOneWhoHasGoneBegins) {
    const auto first = receive(7, resetCommand(7, 5));
    ASSERT_TRUE(first.command);
    inbox_.finish(*first.command, Answer::done());
    gone_.insert(kAnna.writer);
    const auto repeated = receive(7, resetCommand(7, 5), kOtto);
    EXPECT_FALSE(repeated.command) << "it is not carried out twice";
    ASSERT_TRUE(repeated.acknowledgement);
    EXPECT_EQ(repeated.acknowledgement->answer.text, "done");
    EXPECT_TRUE(receive(7, resetCommand(7, 6), kOtto).command);
    gone_.insert(kOtto.writer);
    EXPECT_TRUE(receive(7, resetCommand(7, 1), {3, 33}).command);
}

TEST_F(CommandInboxTest, AFloodOfInventedSendersDrivesOutNobodyElse) {
    EXPECT_TRUE(receive(7, resetCommand(7, 9)).command);
    for (uint64_t invented = 1000; invented < 6000; ++invented)
        ASSERT_TRUE(receive(invented, resetCommand(invented, 1), kOtto).command);
    EXPECT_TRUE(receive(7, resetCommand(7, UINT32_MAX), kOtto).is_foreign) << "it is still known whose it is";
    // As many participants as would fill all.
    for (uint64_t invented = 10'000; invented < 30'000; ++invented) {
        const uint64_t participant = 100 + invented % 64;
        ASSERT_TRUE(receive(invented, resetCommand(invented, 1), {participant, participant}).command);
    }
    EXPECT_TRUE(receive(7, resetCommand(7, UINT32_MAX), kOtto).is_foreign);
}

TEST_F(CommandInboxTest, StillKnowsABusySenderAfterAFloodOfInventedOnes) {
    for (uint64_t invented = 1000; invented < 6000; ++invented) {
        const auto decision = receive(7, resetCommand(7, 1));
        EXPECT_EQ(decision.command.has_value(), invented == 1000);
        ASSERT_TRUE(receive(invented, resetCommand(invented, 1)).command);
    }
}

}  // namespace
}  // namespace bonemill

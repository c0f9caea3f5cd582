#include "haptic_server/recording/journal/journal_chain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "haptic_server/recording/journal/journal_reader.h"
#include "haptic_server/recording/journal/newest_link.h"
#include "tests/support/foreign_mcap.h"
#include "tests/support/rewritten_journal.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/recording/journal/recorded_session.h"

namespace bonemill {
namespace {

using test::JournalMessage;

class JournalChainTest : public testing::Test {
  protected:
    JournalChainTest() {
        JournalConfig config;
        config.path = folder_ / "j.mcap";
        config.manifest.set_rate_hz(1000);
        test::MilledBall ball;
        Journal journal(config, {ball.history.scanned(), ball.bone.lattice});
        test::recordSession(journal, ball);
        journal.finish();
        last_link_ = journal.lastLink();
        messages_ = test::journalMessages(folder_ / "j.mcap");
    }
    static std::string check(const std::filesystem::path& path) {
        ChainCheck chain;
        readJournal(path, [&](JournalTopic topic, const auto& message) { chain.take(topic, message); });
        EXPECT_EQ(chain.isBroken(), chain.text().starts_with("broken between"));
        return chain.text();
    }
    // Says whether the link that was noted is there, and from when it is.
    std::string checkAgainst(const std::string& noted, const std::vector<JournalMessage>& messages) const {
        test::writeJournal(folder_ / "changed.mcap", messages, true);
        ChainCheck chain(noted);
        readJournal(folder_ / "changed.mcap",
                    [&](JournalTopic topic, const auto& message) { chain.take(topic, message); });
        EXPECT_EQ(chain.lacksNoted(), chain.textOfNoted().find("is not in it") != std::string::npos);
        return chain.textOfNoted();
    }
    std::string check(const std::vector<JournalMessage>& messages) const {
        test::writeJournal(folder_ / "changed.mcap", messages, true);
        return check(folder_ / "changed.mcap");
    }
    bool isBroken(const std::vector<JournalMessage>& messages) const {
        return check(messages).starts_with("broken");
    }
    // The first of the topic after the first link.
    size_t place(JournalTopic topic) const {
        const auto link = std::ranges::find(messages_, JournalTopic::kChain, &JournalMessage::topic);
        const auto found =
            std::find_if(link, messages_.end(), [&](const auto& m) { return m.topic == topic; });
        EXPECT_NE(found, messages_.end());
        return size_t(found - messages_.begin());
    }

    test::TemporaryFolder folder_;
    std::string last_link_;
    std::vector<JournalMessage> messages_;
};

TEST_F(JournalChainTest, IsUnbrokenInAJournalAsItWasWritten) {
    EXPECT_EQ(last_link_.size(), 64u);
    EXPECT_EQ(check(folder_ / "j.mcap"), "unbroken, 3 links, the last is " + last_link_);
    EXPECT_FALSE(isBroken(messages_)) << "packing does not count";
    EXPECT_EQ(messages_.back().topic, JournalTopic::kChain) << "all is proven";
}

TEST_F(JournalChainTest, BreaksWhereAMessageWasChangedAddedOrLeftOut) {
    for (const JournalTopic topic : {JournalTopic::kBone, JournalTopic::kInputs, JournalTopic::kStateHash}) {
        std::vector<JournalMessage> changed = messages_;
        std::string& data = changed[place(topic)].data;
        data.back() = char(data.back() ^ 1);
        EXPECT_TRUE(isBroken(changed));
        std::vector<JournalMessage> less = messages_;
        less.erase(less.begin() + std::ptrdiff_t(place(topic)));
        EXPECT_TRUE(isBroken(less));
        std::vector<JournalMessage> more = messages_;
        more.insert(more.begin() + std::ptrdiff_t(place(topic)), messages_[place(topic)]);
        EXPECT_TRUE(isBroken(more));
        std::vector<JournalMessage> later = messages_;
        ++later[place(topic)].time_ns;
        EXPECT_TRUE(isBroken(later));
    }
    std::vector<JournalMessage> swapped = messages_;
    std::swap(swapped[place(JournalTopic::kBone)], swapped[place(JournalTopic::kInputs)]);
    EXPECT_TRUE(isBroken(swapped));
    std::vector<JournalMessage> unlinked = messages_;
    unlinked.erase(unlinked.begin() + std::ptrdiff_t(place(JournalTopic::kChain)));
    EXPECT_TRUE(isBroken(unlinked)) << "a link is left out";
}

// Whoever makes all links anew comes to another last one, which is why it is noted.
TEST_F(JournalChainTest, AForgedChainEndsOtherwise) {
    std::vector<JournalMessage> forged = messages_;
    forged[place(JournalTopic::kBone)].time_ns += 1;
    JournalChain chain;
    for (JournalMessage& message : forged) {
        if (message.topic != JournalTopic::kChain) {
            chain.add(message.topic, message.time_ns, message.data);
            continue;
        }
        journal::Link link;
        link.set_sha256(chain.close());
        message.data = link.SerializeAsString();
    }
    EXPECT_FALSE(isBroken(forged));
    EXPECT_EQ(check(forged).find(last_link_), std::string::npos);
    EXPECT_NE(checkAgainst(last_link_, forged).find("is not in it"), std::string::npos);
}

TEST_F(JournalChainTest, EveryLinkThatWasNotedSaysUntilWhenItProves) {
    EXPECT_EQ(checkAgainst("", messages_), "");
    EXPECT_NE(checkAgainst(std::string(64, '0'), messages_).find("is not in it"), std::string::npos);
    for (const JournalMessage& message : messages_) {
        if (message.topic != JournalTopic::kChain) continue;
        const std::string text = checkAgainst(hexOf(message.as<journal::Link>().sha256()), messages_);
        EXPECT_TRUE(text.starts_with("the link that was noted is that of ")) << text;
    }
    std::vector<JournalMessage> broken = messages_;
    broken[place(JournalTopic::kBone)].time_ns += 1;
    EXPECT_NE(checkAgainst(last_link_, broken).find("is not in it"), std::string::npos);
}

// Other programs give other numbers to the channels, and leave the profile out.
TEST_F(JournalChainTest, AJournalThatAnotherProgramHasWrittenAnewIsTheSame) {
    std::vector<mcap::Channel> channels;
    for (const JournalTopicName& topic : kJournalTopics)
        channels.push_back({uint16_t(100 - int(topic.topic)), 0, std::string(topic.name), "protobuf"});
    std::vector<test::ForeignMessage> messages;
    for (const JournalMessage& message : messages_)
        messages.push_back({uint16_t(100 - int(message.topic)), message.time_ns, message.data});
    const std::filesystem::path path = folder_ / "anew.mcap";
    for (const test::ForeignShape& shape : test::foreignShapes()) {
        std::ofstream(path, std::ios::binary) << test::ForeignMcap(shape).file(channels, messages);
        EXPECT_EQ(check(path), "unbroken, 3 links, the last is " + last_link_) << shape.name;
        const JournalContent content = readJournalContent(path, KeepInputs::kYes);
        EXPECT_EQ(content.problem, "") << shape.name;
        EXPECT_TRUE(content.has_ended) << shape.name;
    }
    std::ofstream(path, std::ios::binary) << test::ForeignMcap({}).file({{1, 1, "/other", "protobuf"}}, {});
    EXPECT_THROW(readJournalContent(path, KeepInputs::kYes), UserError) << "a recording of something else";
}

// An attempt's line in the class table waits for the link that covers it.
TEST(NewestLinkTest, TheLinkAfterTheNextCoversWhatWasPut) {
    using std::chrono::milliseconds;
    NewestLink links;
    EXPECT_EQ(links.awaitAfter(links.count(), milliseconds(1)), "");
    links.set("a");
    const uint64_t put = links.count();
    links.set("b");
    EXPECT_EQ(links.awaitAfter(put, milliseconds(1)), "b") << "no other came in time";
    std::jthread recorder([&] { links.set("c"); });
    EXPECT_EQ(links.awaitAfter(put, std::chrono::minutes(1)), "c");
    recorder.join();
    links.end();
    EXPECT_EQ(links.awaitAfter(links.count(), std::chrono::minutes(1)), "c") << "none comes any more";
}

TEST_F(JournalChainTest, SaysWhatItDoesNotProve) {
    std::vector<JournalMessage> torn = messages_;
    torn.pop_back();
    EXPECT_FALSE(isBroken(torn));
    EXPECT_NE(check(torn).find("what comes after it is not proven"), std::string::npos);
    std::erase_if(torn, [](const JournalMessage& message) { return message.topic == JournalTopic::kChain; });
    EXPECT_EQ(check(torn), "there is none");
}

}  // namespace
}  // namespace bonemill

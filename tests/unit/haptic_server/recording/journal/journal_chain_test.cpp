#include "haptic_server/recording/journal/journal_chain.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "haptic_server/recording/journal/journal_reader.h"
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

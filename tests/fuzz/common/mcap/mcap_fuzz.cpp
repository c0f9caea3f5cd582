// Mutated files go through the reader: nothing crashes (nor makes a sanitizer speak), every change is found,
// and what is told is what was written, up to a chunk's end.
#include <gtest/gtest.h>

#include "tests/support/mcap_bytes.h"
#include "tests/support/mutated_bytes.h"

namespace bonemill {
namespace {

constexpr int kRounds = 20000;

void expectPrefix(const std::vector<std::string>& told, const std::vector<std::string>& written) {
    ASSERT_LE(told.size(), written.size());
    EXPECT_TRUE(std::equal(told.begin(), told.end(), written.begin()));
    EXPECT_EQ(told.size() % 5, 0u) << "the chunks have five messages each";
}

TEST(McapFuzz, FindsEveryChangeInAFinishedFile) {
    std::mt19937 random(2026);
    const auto file = test::mcapFile(6, true);
    size_t told = 0;
    for (int round = 0; round < kRounds; ++round) {
        const std::string bytes = test::mutated(file.bytes, random);
        const auto content = test::readMcap(bytes);
        EXPECT_EQ(content.reading.is_whole, bytes == file.bytes);
        expectPrefix(content.messages, file.messages);
        told += content.messages.size();
    }
    EXPECT_GT(told, size_t(kRounds)) << "most files are good for a while";
}

TEST(McapFuzz, TellsNothingThatWasNotWrittenFromATornFile) {
    std::mt19937 random(2027);
    const auto file = test::mcapFile(6, false);
    for (int round = 0; round < kRounds; ++round) {
        const auto content = test::readMcap(test::mutated(file.bytes, random));
        EXPECT_FALSE(content.reading.is_whole);
        expectPrefix(content.messages, file.messages);
    }
}

// Whoever makes such a file also makes its CRCs: what is in a chunk may be anything.
TEST(McapFuzz, ChecksWhatARightCrcCovers) {
    std::mt19937 random(2028);
    for (int round = 0; round < kRounds / 10; ++round) {
        mcap::Writer writer("bonemill", "bonemill hostile");
        writer.addChannel({uint16_t(random() % 3), 0, "a", ""});
        if (random() % 2) writer.addChannel({uint16_t(random() % 3), 0, "b", ""});
        writer.addMessage(uint16_t(random() % 3), random(), "data");
        writer.finish();
        const auto content = test::readMcap(writer.take());
        EXPECT_EQ(content.reading.is_whole, content.messages.size() == 1);
    }
}

}  // namespace
}  // namespace bonemill

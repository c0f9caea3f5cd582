// What a crash leaves of a file: it is cut anywhere.
#include "common/mcap/mcap_repair.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/base/user_error.h"
#include "tests/support/mcap_bytes.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

using test::mcapFile;
using test::McapFile;
using test::readMcap;

// Of the chunks that are whole in the first `size` bytes.
std::vector<std::string> messagesWithin(const McapFile& file, size_t size) {
    size_t count = 0;
    for (const auto& [end, messages] : file.chunks)
        if (end <= size) count = messages;
    return {file.messages.begin(), file.messages.begin() + std::ptrdiff_t(count)};
}

TEST(TornMcap, EveryChunkBeforeTheCutIsRead) {
    const McapFile file = mcapFile(4, true);
    for (size_t size = 0; size < file.bytes.size(); ++size) {
        const auto content = readMcap(file.bytes.substr(0, size));
        EXPECT_FALSE(content.reading.is_whole) << size;
        EXPECT_FALSE(content.reading.problem.empty()) << size;
        EXPECT_EQ(content.messages, messagesWithin(file, size)) << size;
        EXPECT_EQ(content.reading.index.size() + content.reading.lost_bytes, size);
    }
}

TEST(TornMcap, IsWholeWhenItWasRepaired) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "torn.mcap";
    const McapFile file = mcapFile(3, true);
    const size_t header = 8 + 9 + 4 + 8 + 4 + 13;
    for (size_t size = header; size <= file.bytes.size(); size += 7) {
        const std::string torn = file.bytes.substr(0, size);
        std::ofstream(path, std::ios::binary) << torn;
        const mcap::Reading before = mcap::repair(path);
        EXPECT_EQ(before.is_whole, size == file.bytes.size());
        std::ifstream stream(path, std::ios::binary);
        const std::string repaired{std::istreambuf_iterator<char>(stream), {}};
        const auto content = readMcap(repaired);
        EXPECT_TRUE(content.reading.is_whole) << size << ": " << content.reading.problem;
        EXPECT_EQ(content.messages, messagesWithin(file, size)) << size;
        EXPECT_EQ(repaired.compare(0, before.index.size(), torn, 0, before.index.size()), 0);
    }
}

// Nothing is lost then: the same file comes of it as if it had been finished.
TEST(TornMcap, GetsTheEndThatItWouldHaveHad) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "unfinished.mcap";
    std::ofstream(path, std::ios::binary) << mcapFile(3, false).bytes;
    EXPECT_EQ(mcap::repair(path).lost_bytes, 0u);
    std::ifstream stream(path, std::ios::binary);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), mcapFile(3, true).bytes);
}

std::string contentOf(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// The rest of it may be read by somebody who knows more.
TEST(TornMcap, WhatIsDamagedBeforeItsLastChunkStaysBesideIt) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "1_a.mcap", kept = folder / "1_a.damaged.mcap";
    McapFile file = mcapFile(4, true);
    file.bytes[file.chunks[1].first - 20] ^= 1;
    std::ofstream(path, std::ios::binary) << file.bytes;
    EXPECT_EQ(mcap::repair(path).kept, kept);
    EXPECT_EQ(contentOf(kept), file.bytes);
    EXPECT_TRUE(readMcap(contentOf(path)).reading.is_whole);
}

TEST(TornMcap, ATornChunkAtTheEndIsNotKept) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "1_a.mcap";
    const McapFile file = mcapFile(3, false);
    for (size_t size = file.chunks[1].first; size < file.bytes.size(); size += 5) {
        std::ofstream(path, std::ios::binary) << file.bytes.substr(0, size);
        EXPECT_EQ(mcap::repair(path).kept, "") << size;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "1_a.damaged.mcap"));
}

TEST(TornMcap, WhatIsNoMcapFileIsLeftAlone) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "text.mcap";
    std::ofstream(path) << "a text of somebody";
    EXPECT_THROW(mcap::repair(path), UserError);
    EXPECT_THROW(mcap::repair(folder / "none.mcap"), UserError);
    std::ifstream stream(path);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "a text of somebody");
}

}  // namespace
}  // namespace bonemill

#include <gtest/gtest.h>

#include <cstring>

#include "tests/support/mcap_bytes.h"

namespace bonemill {
namespace {

using test::mcapFile;
using test::readMcap;

template <class Number>
Number numberAt(const std::string& bytes, size_t place) {
    Number number{};
    EXPECT_LE(place + sizeof number, bytes.size());
    std::memcpy(&number, bytes.data() + place, sizeof number);
    return number;
}

TEST(McapFormat, TellsEveryMessageAsItWasWritten) {
    const auto file = mcapFile(4, true);
    const auto content = readMcap(file.bytes);
    EXPECT_TRUE(content.reading.is_whole) << content.reading.problem;
    EXPECT_EQ(content.messages, file.messages);
    EXPECT_EQ(content.reading.profile, "bonemill");
    EXPECT_EQ(content.reading.library, "bonemill test");
    EXPECT_EQ(content.reading.index.chunks(), 4u);
    EXPECT_EQ(content.reading.index.messages(), 20u);
    EXPECT_EQ(content.reading.lost_bytes, 0u);
}

TEST(McapFormat, AFileWithoutMessagesIsWhole) {
    const auto content = readMcap(mcapFile(0, true).bytes);
    EXPECT_TRUE(content.reading.is_whole) << content.reading.problem;
    EXPECT_TRUE(content.messages.empty());
}

// The places are those of the specification, counted here by hand: from the footer to the summary, and from
// its first index of a chunk to the chunk.
TEST(McapFormat, TheFooterLeadsToTheChunks) {
    const std::string bytes = mcapFile(3, true).bytes;
    const std::string magic{"\x89MCAP0\r\n", 8};
    EXPECT_EQ(bytes.substr(0, 8), magic);
    EXPECT_EQ(bytes.substr(bytes.size() - 8), magic);
    const size_t footer = bytes.size() - 8 - (9 + 20);
    EXPECT_EQ(bytes[footer], 0x02);
    EXPECT_EQ(numberAt<uint64_t>(bytes, footer + 1), 20u);
    const auto summary = numberAt<uint64_t>(bytes, footer + 9);
    const auto offsets = numberAt<uint64_t>(bytes, footer + 17);
    const auto crc = numberAt<uint32_t>(bytes, footer + 25);
    EXPECT_EQ(crc, mcap::crcOf(bytes.substr(summary, footer + 25 - summary)));
    EXPECT_EQ(bytes[summary], 0x03);  // the schema
    EXPECT_EQ(bytes[offsets], 0x0E);
    EXPECT_EQ(bytes[summary - 13], 0x0F);  // the end of the data, with the CRC of all before
    EXPECT_EQ(numberAt<uint32_t>(bytes, summary - 4), mcap::crcOf(bytes.substr(0, summary - 13)));
    int chunks = 0;
    for (size_t at = summary; at < offsets; at += 9 + numberAt<uint64_t>(bytes, at + 1)) {
        if (bytes[at] != 0x08) continue;
        ++chunks;
        EXPECT_LE(numberAt<uint64_t>(bytes, at + 9), numberAt<uint64_t>(bytes, at + 17));
        const auto chunk = numberAt<uint64_t>(bytes, at + 25), length = numberAt<uint64_t>(bytes, at + 33);
        EXPECT_EQ(bytes[chunk], 0x06);
        EXPECT_EQ(length, 9 + numberAt<uint64_t>(bytes, chunk + 1));
        EXPECT_EQ(bytes[chunk + length], 0x07);  // the index of its messages
    }
    EXPECT_EQ(chunks, 3);
}

// The CRC of zlib and MCAP, of the usual nine digits.
TEST(McapFormat, TheCrcIsTheUsualOne) {
    EXPECT_EQ(mcap::crcOf("123456789"), 0xCBF43926u);
    EXPECT_EQ(mcap::crcOf("6789", mcap::crcOf("12345")), 0xCBF43926u);
}

TEST(McapFormat, AMessageLargerThanAChunkHasOneOfItsOwn) {
    mcap::Writer writer("bonemill", "bonemill test");
    writer.addChannel({1, 0, "large", "bytes"});
    const std::string large(mcap::kMaxChunk + 1, 'x');
    writer.addMessage(1, 1, "small");
    writer.addMessage(1, 2, large);
    writer.finish();
    const auto content = readMcap(writer.take());
    EXPECT_TRUE(content.reading.is_whole) << content.reading.problem;
    ASSERT_EQ(content.messages.size(), 2u);
    EXPECT_EQ(content.messages[1], "large 1 2 " + large);
    EXPECT_EQ(content.reading.index.chunks(), 2u);
}

// Of so many schemas and channels, of a schema of so many bytes.
std::string fileOf(uint64_t channels, size_t schema_bytes) {
    mcap::Writer writer("bonemill", "bonemill test");
    writer.addSchema({1, "a", "protobuf", std::string(schema_bytes, 'x')});
    for (uint64_t id = 1; id <= channels; ++id) writer.addChannel({uint16_t(id), 1, "t", "protobuf"});
    writer.addMessage(1, 1, "m");
    writer.finish();
    return writer.take();
}

// They pack well, and are kept.
TEST(McapFormat, MoreSchemasAndChannelsThanAreKeptAreRefused) {
    EXPECT_TRUE(readMcap(fileOf(mcap::kMaxRecords - 1, 10)).reading.is_whole);
    EXPECT_TRUE(readMcap(fileOf(1, mcap::kMaxRecordBytes - 1000)).reading.is_whole);
    for (const std::string& file : {fileOf(mcap::kMaxRecords, 10), fileOf(1, mcap::kMaxRecordBytes)}) {
        const auto content = readMcap(file);
        EXPECT_EQ(content.reading.problem.rfind("there are too many schemas and channels", 0), 0u)
            << content.reading.problem;
        EXPECT_TRUE(content.messages.empty());
        EXPECT_EQ(content.reading.index.records(), 0u);
    }
}

}  // namespace
}  // namespace bonemill

// Files that other programs have written, or written anew: what the specification allows is read, and what is
// not, is refused for its true reason.
#include "tests/support/foreign_mcap.h"

#include <gtest/gtest.h>

#include "tests/support/mcap_bytes.h"

namespace bonemill {
namespace {

using test::ForeignMcap;
using test::ForeignMessage;
using test::ForeignShape;
using test::readMcap;

const std::vector<mcap::Channel> kChannels{{40, 40, "things", "protobuf"}, {2, 2, "others", "protobuf"}};

std::vector<ForeignMessage> someMessages() {
    std::vector<ForeignMessage> messages;
    for (uint64_t n = 0; n < 8; ++n)
        messages.push_back(
            {uint16_t(n % 2 ? 2 : 40), 1000 + n, "data " + std::string(n * 20, char('a' + n))});
    return messages;
}

std::vector<std::string> told(const std::vector<ForeignMessage>& messages) {
    std::vector<std::string> all;
    for (size_t n = 0; n < messages.size(); ++n)
        all.push_back(std::string(messages[n].channel == 2 ? "others " : "things ") + std::to_string(n) +
                      ' ' + std::to_string(messages[n].time_ns) + ' ' + messages[n].data);
    return all;
}

std::string fileOf(const ForeignShape& shape) {
    return ForeignMcap(shape).file(kChannels, someMessages());
}

TEST(ForeignMcap, EveryShapeThatIsAllowedIsRead) {
    // Some programs leave the header as it was.
    for (const char* library : {"another program 1", "bonemill test"})
        for (ForeignShape shape : test::foreignShapes()) {
            shape.library = library;
            if (shape.packing == "zstd" && shape.has_crcs && library[0] == 'b')
                continue;  // ours, but for its index
            const auto content = readMcap(fileOf(shape));
            EXPECT_TRUE(content.reading.is_whole) << shape.name << ": " << content.reading.problem;
            EXPECT_TRUE(content.reading.is_foreign) << shape.name;
            EXPECT_EQ(content.messages, told(someMessages())) << shape.name;
        }
    EXPECT_FALSE(readMcap(test::mcapFile(2, true).bytes).reading.is_foreign);
}

TEST(ForeignMcap, WhatIsMissingOrAgainstACrcIsSaid) {
    for (const ForeignShape& shape : test::foreignShapes()) {
        const std::string file = fileOf(shape);
        const auto whole = told(someMessages());
        for (size_t size = 60; size < file.size(); size += 5) {
            const auto content = readMcap(file.substr(0, size));
            EXPECT_FALSE(content.reading.is_whole) << shape.name << " cut at " << size;
            ASSERT_LE(content.messages.size(), whole.size());
            EXPECT_TRUE(std::equal(content.messages.begin(), content.messages.end(), whole.begin()));
        }
        if (!shape.has_crcs) continue;
        for (size_t place = 60; place < file.size(); place += 3) {
            std::string changed = file;
            changed[place] = char(changed[place] ^ 1);
            EXPECT_FALSE(readMcap(changed).reading.is_whole) << shape.name << " changed at " << place;
        }
    }
}

TEST(ForeignMcap, WhatIsNotReadIsRefusedForThat) {
    ForeignShape shape;
    shape.per_chunk = 2;
    shape.packing = "lz4";
    const auto packed = readMcap(fileOf(shape));
    EXPECT_EQ(packed.reading.problem.rfind("its chunks are packed by 'lz4', which is not read here", 0), 0u)
        << packed.reading.problem;
    EXPECT_TRUE(packed.messages.empty());
}

}  // namespace
}  // namespace bonemill

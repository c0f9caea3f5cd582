// What a peer sends is cut into frames, whatever pieces it comes in, and refused before it costs anything.
#include "common/igtl_wire/igtl_frame.h"

#include <gtest/gtest.h>

#include "common/igtl_wire/igtl_bytes.h"
#include "common/igtl_wire/igtl_messages.h"

namespace bonemill::igtl {
namespace {

struct Heard {
    FrameReader reader{{kWantedTransform, kWantedString}};
    std::vector<Frame> frames;
    std::string take(std::string_view bytes) {
        return reader.take(bytes, [this](const Frame& frame) { frames.push_back(frame); });
    }
};

std::string header(uint16_t version, const std::string& type, uint64_t body_bytes, uint64_t crc = 0) {
    std::string bytes;
    append(bytes, version);
    bytes += type + std::string(kTypeBytes - type.size(), '\0') + std::string(kDeviceBytes, '\0');
    append(bytes, uint64_t(0));
    append(bytes, body_bytes);
    append(bytes, crc);
    return bytes;
}

TEST(IgtlFrame, ComesWholeWhateverThePieces) {
    const std::string bytes = stringFrame("one", 1, "reset") + stringFrame("two", 2, "") +
                              transformFrame("three", 3, Eigen::Isometry3d::Identity());
    for (size_t piece = 1; piece <= bytes.size(); ++piece) {
        Heard heard;
        for (size_t at = 0; at < bytes.size(); at += piece)
            ASSERT_EQ(heard.take(std::string_view(bytes).substr(at, piece)), "");
        ASSERT_EQ(heard.frames.size(), 3u) << piece;
        EXPECT_EQ(heard.frames[0].device, "one");
        EXPECT_EQ(stringOf(heard.frames[0].body), "reset");
        EXPECT_EQ(stringOf(heard.frames[1].body), "");
        EXPECT_TRUE(transformOf(heard.frames[2].body)->isApprox(Eigen::Affine3d::Identity()));
        EXPECT_FALSE(heard.reader.isWithin());
    }
}

TEST(IgtlFrame, ABodyOf4GigabytesIsRefusedByItsHeader) {
    for (const char* type : {"TRANSFORM", "STRING", "IMAGE", "NOBODY"}) {
        Heard heard;
        EXPECT_NE(heard.take(header(1, type, uint64_t(4) << 30)), "") << type;
        EXPECT_LT(heard.reader.heldBytes(), 4096u);
        EXPECT_NE(heard.take(stringFrame("", 0, "reset")), "") << "nothing is believed any more";
        EXPECT_TRUE(heard.frames.empty());
    }
    Heard heard;
    EXPECT_NE(heard.take(header(2, "STRING", UINT64_MAX)), "");
}

TEST(IgtlFrame, WhatNobodyAskedForIsReadPastAndKeptNowhere) {
    Heard heard;
    EXPECT_EQ(heard.take(header(1, "IMAGE", FrameReader::kMostSkipped)), "");
    const std::string piece(4096, 'x');
    for (size_t n = 0; n < FrameReader::kMostSkipped; n += piece.size()) EXPECT_EQ(heard.take(piece), "");
    EXPECT_LT(heard.reader.heldBytes(), 4096u);
    EXPECT_EQ(heard.reader.skippedFrames(), 1u);
    EXPECT_EQ(heard.take(stringFrame("", 0, "reset")), "");
    EXPECT_EQ(heard.frames.size(), 1u);
}

TEST(IgtlFrame, RefusesWhatDoesNotFit) {
    const std::string good = transformFrame("T", 0, Eigen::Isometry3d::Identity());
    std::string wrong_sum = good, wrong_version = good;
    wrong_sum[kHeaderBytes + 5] ^= 1;
    wrong_version[0] = 'G';
    EXPECT_NE(Heard().take(wrong_sum), "");
    EXPECT_NE(Heard().take(wrong_version), "");
    EXPECT_NE(Heard().take(header(1, "TRANSFORM", 47)), "");
    EXPECT_NE(Heard().take(header(1, "TRANSFORM", 49)), "");
    EXPECT_NE(Heard().take(header(0, "TRANSFORM", 48)), "");
    EXPECT_NE(Heard().take(header(4, "TRANSFORM", 48)), "");
    EXPECT_NE(Heard().take(std::string(kHeaderBytes, '\xff')), "");
}

// The body of version 3: an extended header, the content, metadata.
std::string thirdVersion(uint16_t before, uint16_t meta_header, uint32_t meta, const std::string& content) {
    std::string body;
    append(body, before), append(body, meta_header), append(body, meta), append(body, uint32_t(7));
    body += content;
    return header(3, "STRING", body.size(), crcOf(body)) + body;
}

TEST(IgtlFrame, TakesTheContentOutOfVersionThree) {
    const std::string content = stringFrame("", 0, "pause").substr(kHeaderBytes);
    Heard heard;
    EXPECT_EQ(heard.take(thirdVersion(12, 2, 3, content + "ab" + "abc")), "");
    ASSERT_EQ(heard.frames.size(), 1u);
    EXPECT_EQ(stringOf(heard.frames[0].body), "pause");
    for (const auto& bad : {thirdVersion(11, 0, 0, content), thirdVersion(12, 0, 100, content),
                            thirdVersion(60000, 0, 0, content), thirdVersion(12, 65535, UINT32_MAX, content)})
        EXPECT_NE(Heard().take(bad), "");
}

TEST(IgtlFrame, ABodyIsReadOnlyWhereItIsOne) {
    EXPECT_FALSE(stringOf(""));
    EXPECT_FALSE(stringOf(std::string("\0\3\0\5abcd", 8))) << "longer than it is";
    EXPECT_FALSE(stringOf(std::string("\0\3\0\3abcd", 8)));
    EXPECT_FALSE(stringOf(std::string("\3\xe8\0\4abcd", 8))) << "UTF-16";
    EXPECT_EQ(stringOf(std::string("\0\3\0\4abcd", 8)), "abcd");
    EXPECT_FALSE(transformOf(std::string(47, '\0')));
    EXPECT_FALSE(transformOf(std::string(48, '\xff'))) << "no numbers";
}

TEST(IgtlFrame, AStampIsUnixTime) {
    EXPECT_EQ(stampOf(0), 0u);
    EXPECT_EQ(stampOf(1'500'000'000), uint64_t(1) << 32 | uint64_t(1) << 31);
    EXPECT_EQ(stampOf(-5), 0u);
}

}  // namespace
}  // namespace bonemill::igtl

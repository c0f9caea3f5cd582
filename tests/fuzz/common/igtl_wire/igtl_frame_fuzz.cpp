// Whatever bytes a peer sends, in whatever pieces, the reader neither crashes nor keeps more than its bounds.
#include <gtest/gtest.h>

#include <random>

#include "common/igtl_wire/igtl_bytes.h"
#include "common/igtl_wire/igtl_messages.h"
#include "tests/support/mutated_bytes.h"

namespace bonemill::igtl {
namespace {

constexpr size_t kMostHeld = kHeaderBytes + 2 * (4 + kLongestString + FrameReader::kMostAround);

std::string thirdVersionOf(const std::string& text) {
    const std::string content = stringFrame("", 0, text).substr(kHeaderBytes);
    std::string body;
    append(body, uint16_t(12)), append(body, uint16_t(2)), append(body, uint32_t(3)),
        append(body, uint32_t(9));
    std::string frame = frameOf("STRING", "third", 0, body + content + "abcde");
    frame[1] = 3;
    return frame;
}

// Makes the checksum right again, so that damage gets past it.
void heal(std::string& frame) {
    if (frame.size() < kHeaderBytes) return;
    std::string tail;
    append(tail, uint64_t(frame.size() - kHeaderBytes));
    append(tail, crcOf(std::string_view(frame).substr(kHeaderBytes)));
    frame.replace(kHeaderBytes - tail.size(), tail.size(), tail);
}

TEST(IgtlFrameFuzz, TakesAnyBytes) {
    std::mt19937 random(36);
    const std::vector<std::string> valid{stringFrame("order", 5, "restore last"), thirdVersionOf("pause"),
                                         transformFrame("T", 7, Eigen::Isometry3d::Identity()),
                                         frameOf("GET_IMAGE", "v", 0, ""), frameOf("IMAGE", "v", 0, "abc")};
    int frames = 0, complaints = 0;
    for (int round = 0; round < 60000; ++round) {
        std::string bytes = test::mutated(valid[size_t(round) % valid.size()], random);
        if (round % 2 == 0) heal(bytes);
        bytes += valid[random() % valid.size()];
        FrameReader reader({kWantedTransform, kWantedString, {"GET_IMAGE", 0, 0}});
        std::string complaint;
        for (size_t at = 0; at < bytes.size();) {
            const size_t piece = 1 + random() % 100;
            complaint = reader.take(std::string_view(bytes).substr(at, piece), [&](const Frame& frame) {
                ++frames;
                EXPECT_LE(stringOf(frame.body).value_or("").size(), kLongestString);
                const auto transform = transformOf(frame.body);
                EXPECT_TRUE(!transform || transform->matrix().allFinite());
            });
            at += piece;
            ASSERT_LE(reader.heldBytes(), kMostHeld);
        }
        complaints += !complaint.empty();
    }
    EXPECT_GT(frames, 20000) << "the damage must leave something to read";
    EXPECT_GT(complaints, 5000);
}

}  // namespace
}  // namespace bonemill::igtl

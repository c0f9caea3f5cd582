// The wire of spacenavd is understood in whatever pieces it comes.
#include <gtest/gtest.h>

#include "device_daemon/hands/input/spnav.h"
#include "tests/unit/device_daemon/hands/input/input_test_tools.h"

namespace bonemill {
namespace {

using test::bytesOf;
using Message = std::array<int32_t, 8>;

TEST(SpnavStream, TakesMotionAndButtons) {
    SpnavStream stream;
    stream.take(bytesOf(Message{0, 10, -20, 30, -40, 50, -60, 8}));
    EXPECT_EQ(stream.counts(), (std::array<int32_t, 6>{10, -20, 30, -40, 50, -60}));
    stream.take(bytesOf(Message{1, 0}));
    stream.take(bytesOf(Message{1, 3}));
    EXPECT_EQ(stream.buttons(), 0b1001u);
    stream.take(bytesOf(Message{2, 0}));
    EXPECT_EQ(stream.buttons(), 0b1000u);
    EXPECT_EQ(stream.counts()[0], 10);
}

TEST(SpnavStream, WaitsForTheRestOfATruncatedMessage) {
    SpnavStream stream;
    const Message message{0, 1, 2, 3, 4, 5, 6, 7};
    for (const std::byte& byte : bytesOf(message)) {
        EXPECT_EQ(stream.counts()[0], 0);
        stream.take({&byte, 1});
    }
    EXPECT_EQ(stream.counts()[5], 6);
}

TEST(SpnavStream, HearsTheAnswerToItsProtocolBetweenMessages) {
    SpnavStream stream;
    stream.take(bytesOf(Message{0, 9}));
    EXPECT_FALSE(stream.hasAnswered());
    stream.take(bytesOf(SpnavStream::kAskForProtocol1));
    EXPECT_TRUE(stream.hasAnswered());
    EXPECT_EQ(stream.protocol(), 1);
    stream.take(bytesOf(Message{0, 11}));
    EXPECT_EQ(stream.counts()[0], 11);
}

TEST(SpnavStream, LetsGoWhenTheDeviceIsUnplugged) {
    SpnavStream stream;
    stream.take(bytesOf(Message{SpnavStream::kAskForDevice[0]}));
    EXPECT_TRUE(stream.hasDevice());
    stream.take(bytesOf(Message{0, 300}));
    stream.take(bytesOf(Message{1, 0}));
    stream.take(bytesOf(Message{3, 1}));
    EXPECT_TRUE(stream.hasChangedDevices());
    EXPECT_FALSE(stream.hasChangedDevices());
    EXPECT_EQ(stream.counts()[0], 0);
    EXPECT_EQ(stream.buttons(), 0u);
    stream.take(bytesOf(Message{SpnavStream::kAskForDevice[0], 0, 0, 0, 0, 0, 0, -1}));
    EXPECT_TRUE(stream.hasToldOfDevice());
    EXPECT_FALSE(stream.hasDevice());
}

TEST(SpnavStream, IgnoresWhatItDoesNotKnow) {
    SpnavStream stream;
    for (const int32_t type : {-1, 4, 5, 99, INT32_MIN, INT32_MAX})
        stream.take(bytesOf(Message{type, 5, 5, 5}));
    stream.take(bytesOf(Message{1, -3}));
    stream.take(bytesOf(Message{1, 1000}));
    EXPECT_EQ(stream.counts(), (std::array<int32_t, 6>{}));
    EXPECT_EQ(stream.buttons(), 1u << 31);
}

}  // namespace
}  // namespace bonemill

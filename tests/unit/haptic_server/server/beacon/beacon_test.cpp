#include "haptic_server/server/beacon/beacon.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <vector>

#include "common/base/user_error.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

// Whoever listens on this PC.
class Listener {
  public:
    Listener() {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
        socklen_t size = sizeof address;
        getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
        const timeval limit{.tv_sec = 20, .tv_usec = 0};
        setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    }
    ~Listener() { close(socket_); }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
    std::vector<uint8_t> receive() {
        std::vector<uint8_t> bytes(2000);
        socklen_t size = sizeof from_;
        const ssize_t count =
            recvfrom(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&from_), &size);
        bytes.resize(size_t(std::max<ssize_t>(count, 0)));
        return bytes;
    }
    void answer(const std::string& text) {
        sendto(socket_, text.data(), text.size(), 0, reinterpret_cast<sockaddr*>(&from_), sizeof from_);
    }

  private:
    int socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    uint16_t port_ = 0;
    sockaddr_in from_{};
};

template <class Value>
Value at(const std::vector<uint8_t>& bytes, size_t place) {
    Value value{};
    for (size_t n = sizeof value; n-- > 0;) value = Value(uint64_t(value) << 8 | bytes.at(place + n));
    return value;
}

TEST(Beacon, EveryByteIsWhereThePageSays) {
    BeaconMessage message;
    message.session = 0x01020304;
    message.sequence = 7;
    message.recording = recordingOf("000102030405060708090a0b0c0d0eff");
    message.epoch = 0x1112131415161718;
    message.scene_hash = 0x2122232425262728;
    message.session_ns = -2;
    message.monotonic_ns = 0x3132333435363738;
    message.realtime_ns = 0x4142434445464748;
    const auto raw = bytesOf(message);
    const std::vector<uint8_t> bytes(raw.begin(), raw.end());
    EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 4), "BMBC");
    EXPECT_EQ(at<uint16_t>(bytes, 4), 1);
    EXPECT_EQ(at<uint16_t>(bytes, 6), 72);
    EXPECT_EQ(at<uint32_t>(bytes, 8), 0x01020304u);
    EXPECT_EQ(bytes[8], 4) << "low byte first";
    EXPECT_EQ(at<uint32_t>(bytes, 12), 7u);
    for (size_t n = 0; n < 15; ++n) EXPECT_EQ(bytes[16 + n], n);
    EXPECT_EQ(bytes[31], 0xff);
    EXPECT_EQ(at<uint64_t>(bytes, 32), 0x1112131415161718u);
    EXPECT_EQ(at<uint64_t>(bytes, 40), 0x2122232425262728u);
    EXPECT_EQ(at<int64_t>(bytes, 48), -2);
    EXPECT_EQ(at<int64_t>(bytes, 56), 0x3132333435363738);
    EXPECT_EQ(at<int64_t>(bytes, 64), 0x4142434445464748);
}

TEST(Beacon, ANameThatIsNoneIsZeros) {
    const std::array<uint8_t, 16> none{};
    EXPECT_EQ(recordingOf(""), none);
    EXPECT_EQ(recordingOf("xx0102030405060708090a0b0c0d0e0f"), none);
    EXPECT_EQ(recordingOf("000102030405060708090a0b0c0d0eff00"), none);
}

TEST(Beacon, TellsBothClocksAndTheSessions) {
    Listener listener;
    Beacon beacon(listener.address(), false);
    ASSERT_TRUE(beacon.isDue());
    const int64_t before_ns = monotonicNowNs();
    beacon.tell({}, before_ns - 5'000'000'000);
    EXPECT_FALSE(beacon.isDue());
    beacon.tell({}, before_ns - 5'000'000'000);
    const std::vector<uint8_t> first = listener.receive(), second = listener.receive();
    ASSERT_EQ(first.size(), kBeaconBytes);
    ASSERT_EQ(second.size(), kBeaconBytes);
    EXPECT_EQ(at<uint32_t>(first, 12), 0u);
    EXPECT_EQ(at<uint32_t>(second, 12), 1u);
    const auto monotonic_ns = at<int64_t>(first, 56);
    EXPECT_GE(monotonic_ns, before_ns);
    EXPECT_LE(monotonic_ns, monotonicNowNs());
    EXPECT_EQ(at<int64_t>(first, 48), monotonic_ns - before_ns + 5'000'000'000);
    EXPECT_GT(at<int64_t>(first, 64), 1'700'000'000'000'000'000);
}

TEST(Beacon, NobodyWhoListensIsNoError) {
    std::string nowhere;
    {
        const Listener gone;
        nowhere = gone.address();
    }
    Beacon beacon(nowhere, false);
    for (int n = 0; n < 3; ++n) EXPECT_NO_THROW(beacon.tell({}, 0));
}

TEST(Beacon, WhatIsAnsweredIsDropped) {
    Listener listener;
    Beacon beacon(listener.address(), false);
    for (int n = 0; n < 3; ++n) {
        beacon.tell({}, 0);
        ASSERT_EQ(listener.receive().size(), kBeaconBytes);
        for (int answer = 0; answer < 100; ++answer) listener.answer(std::string(1400, 'x'));
    }
}

TEST(Beacon, RefusesWhatIsNoAddress) {
    for (const char* const address : {"", "7501", ":7501", "127.0.0.1", "127.0.0.1:", "127.0.0.1:70000",
                                      "localhost:7501", "127.0.0.1:x", "[::1:7501"})
        EXPECT_THROW(Beacon(address, false), UserError) << address;
    EXPECT_THROW(Beacon("255.255.255.255:7501", false), UserError) << "all PCs of the network";
}

}  // namespace
}  // namespace bonemill

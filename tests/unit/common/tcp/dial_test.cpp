#include "common/tcp/dial.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/eventfd.h>

#include <cstring>
#include <memory>

#include "common/tcp/listen.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

bool isAddressOfLocalhost(const std::string& address) {
    addrinfo wish{}, *found = nullptr;
    wish.ai_socktype = SOCK_STREAM;
    if (getaddrinfo("localhost", nullptr, &wish, &found) != 0) return false;
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, &freeaddrinfo);
    for (const addrinfo* at = found; at; at = at->ai_next) {
        sockaddr_storage one{};
        std::memcpy(&one, at->ai_addr, at->ai_addrlen);
        if (textOf(peerAddressOf(one)) == address) return true;
    }
    return false;
}

TEST(Dial, ReachesAHostAtWhicheverOfItsAddressesItListens) {
    for (const char* address : {"127.0.0.1", "::1"}) {
        if (!isAddressOfLocalhost(address)) continue;  // this PC has no IPv6
        const Descriptor listener = listenOn(address, 0);
        const Dialled dialled = dial("localhost", portOf(listener.get()), 5s);
        EXPECT_TRUE(dialled.socket) << address << ": " << dialled.problem;
        EXPECT_TRUE(beginDialAsOf(dialled.socket.get()));
        PeerAddress from{};
        ASSERT_TRUE(acceptFrom(listener.get(), from));
        EXPECT_EQ(textOf(from), address);
    }
}

TEST(Listen, KnowsTheLoopback) {
    for (const char* address : {"127.0.0.1", "127.9.8.7", "::1"}) EXPECT_TRUE(isLoopback(address)) << address;
    for (const char* address : {"0.0.0.0", "::", "10.0.0.127", "::1:1", "2001:db8::1", ""})
        EXPECT_FALSE(isLoopback(address)) << address;
}

TEST(Dial, SaysWhyItReachesNobody) {
    uint16_t port = 0;
    {
        const Descriptor gone = listenOn("127.0.0.1", 0);
        port = portOf(gone.get());
    }
    EXPECT_EQ(dial("127.0.0.1", port, 5s).problem, "nobody answers there");
    const Dialled nameless = dial("no.such.host.invalid", port, 5s);
    EXPECT_FALSE(nameless.socket);
    EXPECT_FALSE(nameless.problem.empty());
}

TEST(Dial, IsGivenUpWhenNobodyWaitsForIt) {
    const Descriptor wake(eventfd(1, EFD_CLOEXEC));
    // Packets to this network are answered nowhere (RFC 5737).
    const auto start = std::chrono::steady_clock::now();
    EXPECT_FALSE(dial("192.0.2.1", 9, 60s, wake.get()).socket);
    EXPECT_LT(std::chrono::steady_clock::now() - start, 60s);
}

TEST(PeerAddress, IsTheSameWhetherIPv4ComesMappedOrNot) {
    sockaddr_storage plain{}, mapped{};
    auto& v4 = reinterpret_cast<sockaddr_in&>(plain);
    v4.sin_family = AF_INET;
    inet_pton(AF_INET, "192.0.2.7", &v4.sin_addr);
    auto& v6 = reinterpret_cast<sockaddr_in6&>(mapped);
    v6.sin6_family = AF_INET6;
    inet_pton(AF_INET6, "::ffff:192.0.2.7", &v6.sin6_addr);
    EXPECT_EQ(peerAddressOf(plain), peerAddressOf(mapped));
    EXPECT_EQ(textOf(peerAddressOf(plain)), "192.0.2.7");
    inet_pton(AF_INET6, "2001:db8::1", &v6.sin6_addr);
    EXPECT_EQ(textOf(peerAddressOf(mapped)), "2001:db8::1");
}

}  // namespace
}  // namespace bonemill

// This is a UDP socket (IPv4) for small packets that must not wait.
//
// Making one throws UserError. Afterwards nothing throws, allocates, locks or blocks but waitUntil(), which
// sleeps until its deadline at most. One thread uses it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace bonemill::wire {

struct Endpoint {
    uint32_t address = 0;  // IPv4, in host byte order
    uint16_t port = 0;
    bool operator==(const Endpoint&) const = default;
};

inline constexpr uint32_t kLoopback = 0x7f000001;

// Either side reads no more datagrams at once, so that a flood cannot hold it.
inline constexpr int kDatagramsAtOnce = 64;

// The one at this port of this machine; none for port 0.
inline std::optional<Endpoint> hereAt(uint16_t port) noexcept {
    return port == 0 ? std::nullopt : std::optional(Endpoint{kLoopback, port});
}

// Reads an address such as "192.168.1.20". Throws UserError.
Endpoint endpointOf(const std::string& address, uint16_t port);
// Returns "127.0.0.1:4040".
std::string textOf(const Endpoint& endpoint);

class UdpSocket {
  public:
    // Binds to loopback unless told otherwise; port 0 takes any free one.
    explicit UdpSocket(const Endpoint& local = {kLoopback, 0});
    UdpSocket(UdpSocket&& other) noexcept;
    UdpSocket& operator=(UdpSocket&& other) noexcept;
    ~UdpSocket();

    // Returns where it is bound, with the port that it got.
    Endpoint local() const noexcept { return local_; }

    // Takes the next datagram, cut to the buffer's size, and says who sent it; empty when there is none.
    // `waited_ns`, if asked for, is how long it lay in the kernel before this program came for it; 0 where
    // nobody knows.
    std::span<const std::byte> receive(std::span<std::byte> buffer, Endpoint& source,
                                       int64_t* waited_ns = nullptr) noexcept;
    // False says that the network took nothing; the packet is then lost as any other may be.
    bool send(std::span<const std::byte> bytes, const Endpoint& to) noexcept;
    // Lets the kernel drop what any host but `source` sends, so that a flood of it cannot fill the queue;
    // nullopt lets all in. What waits already stays. Where the kernel refuses, everybody stays admitted.
    void admitOnly(const std::optional<Endpoint>& source) noexcept;
    // Sleeps until a datagram is there, or until the deadline (CLOCK_MONOTONIC ns). True says that one is.
    bool waitUntil(int64_t deadline_ns) noexcept;

  private:
    int descriptor_ = -1;
    Endpoint local_;
};

}  // namespace bonemill::wire

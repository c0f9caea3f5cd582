#include "common/tcp/peer_address.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <cstring>

namespace bonemill {
namespace {

constexpr char kMapped[] = "\0\0\0\0\0\0\0\0\0\0\xff\xff";
constexpr size_t kMappedBytes = sizeof kMapped - 1;

}  // namespace

PeerAddress peerAddressOf(const sockaddr_storage& address) {
    PeerAddress peer{};
    if (address.ss_family == AF_INET6) {
        std::memcpy(peer.data(), &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr, peer.size());
    } else {
        std::memcpy(peer.data(), kMapped, kMappedBytes);
        std::memcpy(peer.data() + kMappedBytes, &reinterpret_cast<const sockaddr_in&>(address).sin_addr,
                    peer.size() - kMappedBytes);
    }
    return peer;
}

std::string textOf(const PeerAddress& address) {
    char text[INET6_ADDRSTRLEN] = "?";
    if (std::memcmp(address.data(), kMapped, kMappedBytes) == 0) {
        inet_ntop(AF_INET, address.data() + kMappedBytes, text, sizeof text);
    } else {
        inet_ntop(AF_INET6, address.data(), text, sizeof text);
    }
    return text;
}

}  // namespace bonemill

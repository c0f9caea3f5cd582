// What a gateway and its relay say to each other before they pass bytes on (docs/howto/gateway.md, "Relay").
// A gateway proves by a shared secret that it is one; guests know nothing of it: their first byte, a TLS
// record's, tells them apart.
//
//   gateway  kMagic, Ask, GuestId (zeros with kControl)
//   relay    Nonce
//   gateway  Proof = HMAC-SHA256(secret, kMagic, Ask, GuestId, Nonce)
//   relay    kAccepted
//
// On a kControl line the relay then says kGuestCame, a GuestId and a PeerAddress for each guest, for which
// the gateway opens a kGuest line, and kPing, which the gateway answers with kPing. On a kGuest line the
// guest's bytes follow. The functions are thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/tcp/listen.h"

namespace bonemill {

inline constexpr std::string_view kRelayMagic = "BMRELAY1";
inline constexpr char kRelayAccepted = 'K', kGuestCame = 'G', kRelayPing = 'P';
inline constexpr uint8_t kTlsHandshakeByte = 0x16;

enum class RelayAsk : char { kControl = 'C', kGuest = 'D' };
using GuestId = std::array<char, 16>;
using RelayNonce = std::array<char, 32>;
using RelayProof = std::array<char, 32>;
inline constexpr size_t kGreetingBytes = kRelayMagic.size() + 1 + std::tuple_size_v<GuestId>;
inline constexpr size_t kGuestCameBytes = 1 + std::tuple_size_v<GuestId> + std::tuple_size_v<PeerAddress>;

std::string greetingOf(RelayAsk ask, const GuestId& guest);
RelayProof proofOf(std::string_view secret, std::string_view greeting, const RelayNonce& nonce);

// What a relay is to do (render_client --relay), and what a gateway must know of its relay (--via).
struct RelayOptions {
    std::string address = "127.0.0.1";  // it listens there
    uint16_t port = 0;                  // 0: any
    std::string secret;                 // shared with the gateway
};

struct RelayPlace {
    std::string host;
    uint16_t port = 0;
    std::string secret;
};

}  // namespace bonemill

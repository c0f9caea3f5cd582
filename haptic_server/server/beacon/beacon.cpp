#include "haptic_server/server/beacon/beacon.h"

#include <netdb.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

static_assert(std::endian::native == std::endian::little,
              "beacons are little-endian, and numbers are copied");

constexpr char kMagic[4] = {'B', 'M', 'B', 'C'};
constexpr uint16_t kVersion = 1;

template <class Value>
uint8_t* put(uint8_t* at, const Value& value) {
    std::memcpy(at, &value, sizeof value);
    return at + sizeof value;
}

int64_t realtimeNowNs() {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    return int64_t(now.tv_sec) * kNsPerSecond + now.tv_nsec;
}

using Addresses = std::unique_ptr<addrinfo, void (*)(addrinfo*)>;

// No name is looked up: that could take seconds.
Addresses addressesOf(const std::string& text) {
    const size_t colon = text.rfind(':');
    std::string host = text.substr(0, colon == std::string::npos ? 0 : colon);
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
    addrinfo wish{}, *found = nullptr;
    wish.ai_socktype = SOCK_DGRAM;
    wish.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
    uint16_t port = 0;  // getaddrinfo() takes 70000 for 4464
    const char* const end = text.data() + text.size();
    const bool is_named = colon != std::string::npos && !host.empty() &&
                          std::from_chars(text.data() + colon + 1, end, port).ptr == end && port != 0;
    if (!is_named || getaddrinfo(host.c_str(), text.c_str() + colon + 1, &wish, &found) != 0)
        throw UserError("--beacon " + text + ": expected ADDRESS:PORT in numbers, such as 192.168.1.20:7501");
    return {found, freeaddrinfo};
}

}  // namespace

std::array<uint8_t, kBeaconBytes> bytesOf(const BeaconMessage& message) {
    std::array<uint8_t, kBeaconBytes> bytes{};
    uint8_t* at = put(bytes.data(), kMagic);
    at = put(put(at, kVersion), uint16_t(kBeaconBytes));
    at = put(put(at, message.session), message.sequence);
    at = put(at, message.recording);
    at = put(put(at, message.epoch), message.scene_hash);
    put(put(put(at, message.session_ns), message.monotonic_ns), message.realtime_ns);
    return bytes;
}

std::array<uint8_t, 16> recordingOf(const std::string& journal_id) {
    std::array<uint8_t, 16> bytes{};
    if (journal_id.size() != 2 * bytes.size()) return bytes;
    for (size_t n = 0; n < bytes.size(); ++n) {
        const char* const digits = journal_id.data() + 2 * n;
        if (std::from_chars(digits, digits + 2, bytes[n], 16).ptr != digits + 2) return {};
    }
    return bytes;
}

// Connected and shut for reading: the kernel drops whatever comes.
Beacon::Beacon(const std::string& address, bool allows_broadcast) : address_(address) {
    const Addresses addresses = addressesOf(address);
    socket_ = socket(addresses->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const int yes = 1;
    if (allows_broadcast) setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes);
    if (connect(socket_, addresses->ai_addr, addresses->ai_addrlen) == 0) {
        shutdown(socket_, SHUT_RD);
        return;
    }
    const int why = errno;
    close(socket_);
    throw UserError("--beacon " + address + ": nothing can be sent there (" + std::strerror(why) + ")" +
                    (why == EACCES ? "; an address of all PCs needs --beacon-broadcast" : ""));
}

Beacon::~Beacon() {
    close(socket_);
}

bool Beacon::isDue() const {
    return sent_ns_ == 0 || monotonicNowNs() - sent_ns_ >= kPeriodNs;
}

// Where nobody listens, the network may say so: that is no error. Else it is told of once.
void Beacon::tell(BeaconMessage message, int64_t session_began_ns) {
    message.monotonic_ns = monotonicNowNs();
    message.realtime_ns = realtimeNowNs();
    message.session_ns = message.monotonic_ns - session_began_ns;
    message.sequence = sequence_++;
    sent_ns_ = message.monotonic_ns;
    const auto bytes = bytesOf(message);
    const bool is_sent = send(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL) >= 0;
    if (is_sent || errno == ECONNREFUSED || has_told_of_error_) return;
    has_told_of_error_ = true;
    spdlog::warn("--beacon {}: {}; the session goes on", address_, std::strerror(errno));
}

}  // namespace bonemill

// A datagram that tells the session's clock beside the PC's, for programs that record something else at the
// same time (docs/reference/beacon.md). It is off unless an address is given; nothing is received. The tick
// has nothing to do with it: a normal thread sends, and never waits.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace bonemill {

// As the table in docs/reference/beacon.md has it.
struct BeaconMessage {
    uint32_t session = 0;                 // its number
    uint32_t sequence = 0;                // of the server's beacons, from 0
    std::array<uint8_t, 16> recording{};  // what names the journal; zeros: nothing is recorded
    uint64_t epoch = 0;
    uint64_t scene_hash = 0;
    int64_t session_ns = 0;    // since the session's first tick
    int64_t monotonic_ns = 0;  // CLOCK_MONOTONIC of the server's PC, at the same moment
    int64_t realtime_ns = 0;   // CLOCK_REALTIME, likewise
};
constexpr size_t kBeaconBytes = 72;
std::array<uint8_t, kBeaconBytes> bytesOf(const BeaconMessage& message);
// Of a journal's name in 32 hexadecimal digits; zeros for anything else.
std::array<uint8_t, 16> recordingOf(const std::string& journal_id);

// For one thread at a time.
class Beacon {
  public:
    static constexpr int64_t kPeriodNs = 200'000'000;

    // To ADDRESS:PORT, both numbers; [ADDRESS]:PORT for IPv6. Throws UserError: an address that is none, or
    // one of all PCs of a network that was not allowed.
    Beacon(const std::string& address, bool allows_broadcast);
    ~Beacon();
    Beacon(const Beacon&) = delete;
    Beacon& operator=(const Beacon&) = delete;

    // The next one is to be sent now, a period after the one before.
    bool isDue() const;
    // Sends what the session is, and its clock, which began at this moment of CLOCK_MONOTONIC. Sequence and
    // clocks of the message are filled in.
    void tell(BeaconMessage message, int64_t session_began_ns);

  private:
    std::string address_;
    int socket_ = -1;
    uint32_t sequence_ = 0;
    int64_t sent_ns_ = 0;
    bool has_told_of_error_ = false;
};

}  // namespace bonemill

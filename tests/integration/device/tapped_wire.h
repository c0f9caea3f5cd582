// Stands between device_daemon and the ares_emulator that it starts, passes every packet on, and writes down
// what is ordered and what the motors give. It can take the enabling switch out of the scripted hand.
//
// The daemon must be started as daemonIn() says. A thread of its own passes packets on; everything else is
// for the test's thread.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "device_daemon/ares/wire/packets.h"
#include "device_daemon/ares/wire/udp_socket.h"

namespace bonemill::test {

// It is what a JointCommand orders, or what a JointState says.
struct WirePacket {
    bool is_command = false;
    uint32_t session = 0;
    uint32_t sequence = 0;
    uint32_t reflected = 0;     // sequence of the other side
    double force = 0;           // N, norm over the six motors: ordered, or given
    int64_t host_ns = 0;        // of a command
    bool is_engaged = false;    // a command's: the hand feels haptic_server
    bool is_on = false;         // a state's: the drive obeys
    bool holds_switch = false;  // a state's, as the daemon reads it
};

enum class EnablingSwitch { kOfTheHand, kHeld };

class TappedWire {
  public:
    TappedWire();

    // Puts a copy of device_daemon into the folder, with an ares_emulator beside it that listens behind this
    // wire. Returns the daemon's path.
    std::string daemonIn(const std::string& folder) const;

    void set(EnablingSwitch enabling) { switch_ = enabling; }
    // Returns what has passed since the last call, in its order.
    std::vector<WirePacket> take();

  private:
    void relay(const std::stop_token& stop);
    void pass(std::span<const std::byte> bytes, const wire::Endpoint& source);
    void passState(wire::JointState state);
    void note(const WirePacket& packet);

    wire::UdpSocket socket_;
    wire::Endpoint emulator_, daemon_;
    std::atomic<EnablingSwitch> switch_{EnablingSwitch::kOfTheHand};
    std::mutex mutex_;
    std::vector<WirePacket> passed_;
    std::jthread thread_;
};

}  // namespace bonemill::test

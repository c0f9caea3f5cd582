// PCs on a switch, made of Linux network namespaces: veth pairs, a bridge, TAP devices. Everything is gone
// with the process. For tests with one thread: a namespace belongs to a thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace bonemill::test {

// Closes itself.
class Descriptor {
  public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept;
    Descriptor& operator=(Descriptor&& other) noexcept;
    ~Descriptor();
    int number() const { return number_; }

  private:
    int number_;
};

// What a bad line does to frames, in each direction.
struct LineQuality {
    int rate_kbit_per_s = 0;  // 0: no limit
    int delay_ms = 0;
    int loss_per_mille = 0;
    int queue_kib = 256;  // waiting frames beyond it are lost
};

// A PC with the interface eth0 on the switch.
class Host {
  public:
    // Starts a program on this PC (tests/support/process.h).
    std::unique_ptr<Process> start(const std::vector<std::string>& arguments) const;
    // Bound to this port of this PC, 5 s until a read gives up.
    Descriptor udpSocket(int port) const;
    struct Traffic {
        uint64_t sent_bytes = 0;
        uint64_t received_bytes = 0;
    };
    // Through its cable so far.
    Traffic traffic() const;
    const std::string& address() const { return address_; }
    // The cable at the switch.
    void unplug() const;
    void plugIn() const;

  private:
    friend class VirtualNetwork;
    Descriptor namespace_;
    std::string address_;
    std::string port_;                // of the switch
    std::unique_ptr<Process> relay_;  // a bad line's
};

class VirtualNetwork {
  public:
    // Moves this process into a network of its own. Returns what is missing for that here, in one line; empty
    // when nothing is. First call of a test.
    static std::string enter();
    // What is missing for bad lines; also once this process has entered.
    static std::string missingForLines();

    // The switch. Throws std::runtime_error as everything here does.
    VirtualNetwork();

    // 10.77.0.1 and up, in this order.
    Host addHost();
    // Through tests/support/link_relay.cpp, with frames lost in a fixed order.
    Host addHost(const LineQuality& line);

  private:
    Host newHost();
    void setUpInside(const Host& host) const;
    int hosts_ = 0;
};

}  // namespace bonemill::test

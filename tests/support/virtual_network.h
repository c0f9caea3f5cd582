// Makes PCs on a switch of Linux network namespaces, with veth pairs, a bridge and TAP devices. Everything is
// gone with the process. It is for tests with one thread, because a namespace belongs to a thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace bonemill::test {

// It closes itself.
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

// It says what a bad line does to frames, in each direction.
struct LineQuality {
    int rate_kbit_per_s = 0;  // 0: no limit
    int delay_ms = 0;
    int loss_per_mille = 0;
    int queue_kib = 256;  // waiting frames beyond it are lost
};

// This is a PC with the interface eth0 on the switch.
class Host {
  public:
    // Starts a program on this PC (tests/support/process.h).
    std::unique_ptr<Process> start(const std::vector<std::string>& arguments) const;
    // The socket is bound to this port of this PC, and a read gives up after 5 s.
    Descriptor udpSocket(int port) const;
    struct Traffic {
        uint64_t sent_bytes = 0;
        uint64_t received_bytes = 0;
    };
    // So much went through its cable so far.
    Traffic traffic() const;
    const std::string& address() const { return address_; }
    // Pulls the cable at the switch.
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
    // Moves this process into a network of its own. Returns what is missing for that here, in one line, or
    // nothing. It is the first call of a test.
    static std::string enter();
    // Returns what is missing for bad lines; it may be asked also once this process has entered.
    static std::string missingForLines();

    // Makes the switch. It throws std::runtime_error as everything here does.
    VirtualNetwork();

    // Hosts get 10.77.0.1 and up, in this order.
    Host addHost();
    // The host is behind tests/support/link_relay.cpp, which loses frames in a fixed order.
    Host addHost(const LineQuality& line);

  private:
    Host newHost();
    void setUpInside(const Host& host) const;
    int hosts_ = 0;
};

}  // namespace bonemill::test

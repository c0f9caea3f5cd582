// A wire between whoever dials it and a port of this PC, which keeps what goes through: for tests. It has a
// thread of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "common/tcp/descriptor.h"

namespace bonemill::test {

class WireTap {
  public:
    // It dials 127.0.0.1:`to` from `from`, an address of the loopback.
    explicit WireTap(uint16_t to, std::string from = "127.0.0.1");
    ~WireTap();
    WireTap(const WireTap&) = delete;
    WireTap& operator=(const WireTap&) = delete;

    uint16_t port() const;
    // Everything so far, in both directions.
    std::string heard() const;

  private:
    struct Wire {
        Descriptor near, far;
    };
    void run();
    Descriptor dialOut() const;
    // Returns false when one end is gone.
    bool passOn(const Descriptor& source, const Descriptor& sink);

    const uint16_t to_;
    const std::string from_;
    Descriptor listener_;
    mutable std::mutex mutex_;
    std::string heard_;
    std::atomic<bool> should_stop_ = false;
    std::thread thread_;
};

}  // namespace bonemill::test

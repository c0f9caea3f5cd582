// This is the link between device_daemon, which writes DeviceSample, and haptic_server, which writes
// WrenchCommand: POSIX shared memory with one seqlock per direction and a futex for whoever waits.
//
// Whoever starts first makes the memory, and each side may die and come back. The newest value is all
// that counts: nothing queues. Reading and writing are RT-safe: they are bounded, and a wake is one
// system call, made only when the peer waits. Opening, peerIsAlive() and the destructor are not. One
// thread uses a DeviceLink.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "common/device_messages/device_messages.h"

namespace bonemill {

enum class LinkSide { kServer, kDaemon };

struct LinkMemory;

class DeviceLink {
  public:
    // Creates the memory or attaches to it. The memory of dead processes is taken over: a living peer's
    // content is kept, else it starts empty. Throws UserError when the memory is not ours, the peer was built
    // with another layout or has read another scene, a living process has taken this side, or there is no
    // permission.
    static DeviceLink create(uint32_t session, LinkSide side, uint64_t scene_hash);

    DeviceLink(DeviceLink&& other) noexcept;
    DeviceLink& operator=(DeviceLink&&) = delete;
    // Removes the memory if the peer is gone too.
    ~DeviceLink();

    // For the daemon: publishes and wakes; `sequence` is filled in and returned.
    uint64_t writeSample(DeviceSample sample) noexcept;
    // For the server: reads the newest sample, also if it was read before (compare `sequence`). False says
    // that there is none yet, or that the writer died in the middle of one; `sample` is untouched then.
    // Nothing is validated here: see isPlausible().
    bool readSample(DeviceSample& sample) noexcept;
    // For the server: sleeps until there is a sample newer than the last one read (true) or
    // until deadline_ns (CLOCK_MONOTONIC).
    bool waitForSample(int64_t deadline_ns) noexcept;

    // The same in the other direction: the server writes, the daemon reads and waits.
    uint64_t writeCommand(WrenchCommand command) noexcept;
    bool readCommand(WrenchCommand& command) noexcept;
    bool waitForCommand(int64_t deadline_ns) noexcept;

    // For the daemon: says what device there is. For the server: true when that has changed since the last
    // call.
    void writeCapabilities(const DeviceCapabilities& capabilities) noexcept;
    bool readCapabilities(DeviceCapabilities& capabilities) noexcept;

    // Says "this process runs" where there is nothing to write. Every write beats, too.
    void beat(int64_t now_ns) noexcept;
    // Returns the peer's last beat, CLOCK_MONOTONIC; 0 if there was none.
    int64_t peerHeartbeatNs() const noexcept;
    int32_t peerPid() const noexcept;  // 0: not attached
    // Asks the kernel whether the peer's process holds its side of the link. It is not RT-safe.
    bool peerIsAlive() const noexcept;

  private:
    DeviceLink(std::string name, LinkSide side, int file, LinkMemory* memory) noexcept;

    std::string name_;
    LinkSide side_;
    int file_;
    LinkMemory* memory_;
    uint32_t read_version_ = 0;  // seqlock version of the last value read
    uint32_t capabilities_version_ = 0;
};

}  // namespace bonemill

// This is the link between device_daemon, which writes DeviceSample, and haptic_server, which writes
// WrenchCommand: shared memory with one seqlock per direction and a futex for whoever waits.
//
// Whoever starts first makes the memory, and each side may die and come back. The newest value is all
// that counts: nothing queues. Reading and writing are RT-safe: they are bounded, and a wake is one
// system call, made only when the peer waits. Opening, peerIsAlive() and the destructor are not; they wait
// 2 s at most. One thread uses a DeviceLink.
//
// It is System V memory, because the kernel fixes its size for its life, knows who made it, and keeps
// semaphores that a dying process gives back. POSIX shared memory is a file that any process with the right
// to write can cut short, which ends its readers by SIGBUS; here only root could, through
// /proc/PID/map_files, who can end them anyway. A sealed memfd withstands even that, but a process must live
// that hands it out, and answer while stopped or busy; here either side may be the first or the last. Both
// programs must run as the same user and in the same IPC namespace.
#pragma once

#include <cstdint>
#include <string>

#include "common/device_messages/device_messages.h"
#include "common/ipc/link_place.h"
#include "common/ipc/link_segment.h"

namespace bonemill {

class DeviceLink {
  public:
    // Creates the memory or attaches to it: a living peer's content is kept, that of the dead makes way for
    // empty memory. Throws UserError when what lies there is another user's, open to others or no link's, the
    // peer was built with another layout, a living process has taken this side, or
    // one is stuck while it starts.
    static DeviceLink create(uint32_t session, LinkSide side);

    DeviceLink(DeviceLink&&) noexcept = default;
    DeviceLink& operator=(DeviceLink&&) = delete;
    // Removes the memory if the peer is gone too. Where another process is stuck while it starts, the memory
    // stays and the next start takes it over.
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

    // For the server: says that this scene is in force, and returns its revision. Throws UserError if the
    // path is too long. It is not RT-safe; any one thread may call it beside the tick.
    uint32_t announceScene(const std::string& absolute_path, uint64_t hash, uint64_t epoch = 0);
    // For the server: says that an attempt begins, or that the one under way ends, in the scene that was
    // announced. It is not RT-safe; any one thread may call it beside the tick.
    void announceAttempt(bool begins);
    // For the server: says which hand it wants; the daemon's own scripted hand does its script anew. It holds
    // until another scene is announced. It is not RT-safe; any one thread may call it beside the tick.
    void announceHand(HandChoice hand);
    // For the daemon: reads what was announced last; false if nothing plausible was. Any thread may call it
    // beside the loop.
    bool readScene(SceneNotice& notice) const noexcept;

    // Says "this process runs" where there is nothing to write. Every write beats, too.
    void beat(int64_t now_ns) noexcept;
    // Returns the peer's last beat, CLOCK_MONOTONIC; 0 if there was none.
    int64_t peerHeartbeatNs() const noexcept;
    // Asks the kernel whether a process holds the peer's side of the link: one system call, and not RT-safe.
    // A stopped process lives.
    bool peerIsAlive() const noexcept;

  private:
    DeviceLink(LinkSide side, LinkSemaphores semaphores, LinkSegment memory) noexcept;

    LinkSide side_;
    LinkSemaphores semaphores_;
    LinkSegment memory_;
    uint32_t read_version_ = 0;  // seqlock version of the last value read
    uint32_t capabilities_version_ = 0;
};

}  // namespace bonemill

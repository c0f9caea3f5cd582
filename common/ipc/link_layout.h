// This is the byte layout of the shared memory behind DeviceLink. Only the link and its tests need it.
//
// The fields up to `size` and the lock bytes never change, so that programs of different versions can
// recognise each other. Any other change of this file raises kLinkLayoutVersion.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "common/device_messages/device_messages.h"
#include "common/rt/seqlock.h"

namespace bonemill {

inline constexpr uint64_t kLinkMagic = 0x4b4e494c4c494d42;  // "BMILLINK" in memory
inline constexpr uint32_t kLinkLayoutVersion = 2;

// These are advisory locks (fcntl, per open file) on single bytes of the memory file. The kernel drops them
// when a process dies, so that a held byte means a living process: no pid can be mistaken.
enum LinkLockByte : int64_t { kLockSetup = 0, kLockServer = 1, kLockDaemon = 2 };

struct LinkPeer {
    std::atomic<int32_t> pid;
    uint32_t reserved;
    std::atomic<int64_t> heartbeat_ns;
    std::atomic<uint64_t> last_sequence;  // of what this side wrote; a restarted process counts on from it
    std::atomic<uint64_t> scene_hash;     // of the scene that this side has read
};

template <class T>
struct alignas(64) LinkChannel {
    Seqlock<T> value;                  // its counter is the futex word
    std::atomic<uint32_t> is_awaited;  // the reader sleeps, or is about to: the writer must wake it
};

struct LinkMemory {
    uint64_t magic;
    uint32_t layout_version;
    uint32_t size;
    LinkPeer server;
    LinkPeer daemon;
    LinkChannel<DeviceSample> sample;
    LinkChannel<WrenchCommand> command;
    LinkChannel<DeviceCapabilities> capabilities;
};
static_assert(std::is_standard_layout_v<LinkMemory>);
static_assert(sizeof(LinkPeer) == 32 && sizeof(LinkChannel<DeviceSample>) == 192);
static_assert(offsetof(LinkMemory, layout_version) == 8 && offsetof(LinkMemory, size) == 12 &&
              offsetof(LinkMemory, server) == 16 && offsetof(LinkMemory, daemon) == 48 &&
              offsetof(LinkMemory, sample) == 128 && offsetof(LinkMemory, command) == 320 &&
              offsetof(LinkMemory, capabilities) == 448 && sizeof(LinkMemory) == 576);

}  // namespace bonemill

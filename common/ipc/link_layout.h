// This is the byte layout of the shared memory behind DeviceLink. Only the link and its tests need it.
//
// The header, the key (linkKeyOf) and the semaphores never change, so that programs of different versions can
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
inline constexpr uint32_t kLinkLayoutVersion = 6;

// The set of semaphores with the memory's key: 0 is free, 1 is held.
enum LinkSemaphore : unsigned short { kSetupSemaphore = 0, kServerSemaphore = 1, kDaemonSemaphore = 2 };
inline constexpr int kLinkSemaphoreCount = 3;

struct LinkHeader {
    uint64_t magic;  // written last
    uint32_t layout_version;
    uint32_t size;
};

struct LinkPeer {
    std::atomic<int64_t> heartbeat_ns;
    std::atomic<uint64_t> last_sequence;  // of what this side wrote; a restarted process counts on from it
};

template <class T>
struct alignas(64) LinkChannel {
    Seqlock<T> value;                  // its counter is the futex word
    std::atomic<uint32_t> is_awaited;  // the reader sleeps, or is about to: the writer must wake it
};

struct LinkMemory {
    LinkHeader header;
    LinkPeer server;
    LinkPeer daemon;
    LinkChannel<DeviceSample> sample;
    LinkChannel<WrenchCommand> command;
    LinkChannel<DeviceCapabilities> capabilities;
    LinkChannel<SceneNotice> scene;
};
static_assert(std::is_standard_layout_v<LinkMemory>);
static_assert(sizeof(LinkHeader) == 16 && offsetof(LinkHeader, layout_version) == 8 &&
              offsetof(LinkHeader, size) == 12);
static_assert(sizeof(LinkPeer) == 16 && sizeof(LinkChannel<DeviceSample>) == 192);
static_assert(offsetof(LinkMemory, header) == 0 && offsetof(LinkMemory, server) == 16 &&
              offsetof(LinkMemory, daemon) == 32 && offsetof(LinkMemory, sample) == 64 &&
              offsetof(LinkMemory, command) == 256 && offsetof(LinkMemory, capabilities) == 384 &&
              offsetof(LinkMemory, scene) == 576 && sizeof(LinkMemory) == 1664);

}  // namespace bonemill

#include "common/ipc/link_segment.h"

#include <sys/shm.h>

#include <cerrno>
#include <cstring>
#include <new>
#include <string>

namespace bonemill {
namespace {

constexpr int kNoSegment = -1;

shmid_ds segmentStatus(int id, int how) noexcept {
    shmid_ds status{};
    shmctl(id, how, &status);
    return status;
}

[[noreturn]] void refuseWithReason(const LinkPlace& place, const char* what, int error) {
    place.refuse(std::string(what) + ": " + std::strerror(error) +
                 "; `ipcs -u` shows what the system holds, `ipcs -l` its limits");
}

// Returns the segment at the place, once its owner is checked, or kNoSegment.
int find(const LinkPlace& place) {
    const int id = shmget(place.key(), 0, 0);  // asks for no right, so that it finds a foreign one, too
    if (id < 0) return kNoSegment;
    const shmid_ds status = segmentStatus(id, SHM_STAT_ANY);
    if (status.shm_perm.__key != place.key()) return kNoSegment;  // removed just now
    place.checkOwner(status.shm_perm, 'M');
    return id;
}

void* attach(const LinkPlace& place, int id, int flags) {
    void* const memory = shmat(id, nullptr, flags);
    // The C library says failure with this address.
    if (memory == reinterpret_cast<void*>(-1))
        refuseWithReason(place, "its memory cannot be attached", errno);
    return memory;
}

// Reads what every release has at the beginning. A segment has whole pages, so it is there to be read.
LinkHeader readHeader(const LinkPlace& place, int id) {
    const void* const memory = attach(place, id, SHM_RDONLY);
    LinkHeader header;
    std::memcpy(&header, memory, sizeof(header));
    shmdt(memory);
    return header;
}

// Magic 0 says that the maker died before it was done.
void removeOldMemory(const LinkPlace& place, int id) {
    const uint64_t magic = readHeader(place, id).magic;
    if (magic != kLinkMagic && magic != 0) {
        place.refuse(
            "what lies there is not a bonemill device link (wrong magic number); choose another --session, "
            "or " +
            place.removal('M'));
    }
    shmctl(id, IPC_RMID, nullptr);
}

void checkLiving(const LinkPlace& place, int id, LinkSide side) {
    const std::string peer = programOf(peerOf(side));
    const LinkHeader header = readHeader(place, id);
    if (header.magic != kLinkMagic) {
        place.refuse("what lies there is not a bonemill device link (wrong magic number); stop " + peer +
                     ", or choose another --session");
    }
    if (header.layout_version != kLinkLayoutVersion) {
        place.refuse("its memory has layout version " + std::to_string(header.layout_version) + ", this " +
                     programOf(side) + " needs " + std::to_string(kLinkLayoutVersion) + ": run " + peer +
                     " of the same release");
    }
    if (header.size != sizeof(LinkMemory) || segmentStatus(id, IPC_STAT).shm_segsz != sizeof(LinkMemory))
        place.refuse("its memory has a wrong size: stop " + peer + " and start it again");
}

}  // namespace

LinkSegment LinkSegment::make(const LinkPlace& place) {
    const int old = find(place);
    if (old != kNoSegment) removeOldMemory(place, old);
    // With IPC_EXCL it is ours from its first byte on.
    const int id = shmget(place.key(), sizeof(LinkMemory), IPC_CREAT | IPC_EXCL | 0600);
    if (id < 0) refuseWithReason(place, "its memory cannot be made", errno);
    LinkMemory* const memory = new (attach(place, id, 0)) LinkMemory{};
    memory->header.layout_version = kLinkLayoutVersion;
    memory->header.size = sizeof(LinkMemory);
    memory->header.magic = kLinkMagic;
    return {id, memory};
}

LinkSegment LinkSegment::join(const LinkPlace& place, LinkSide side) {
    const int id = find(place);
    if (id == kNoSegment) {
        const std::string peer = programOf(peerOf(side));
        place.refuse(peer + " lives, but somebody has removed its memory: stop " + peer +
                     " and start it again");
    }
    checkLiving(place, id, side);
    return {id, static_cast<LinkMemory*>(attach(place, id, 0))};
}

LinkSegment::~LinkSegment() {
    if (memory_) shmdt(memory_);
}

void LinkSegment::remove() const noexcept {
    shmctl(id_, IPC_RMID, nullptr);
}

}  // namespace bonemill

#include "common/ipc/device_link.h"

#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <utility>

#include "common/ipc/link_layout.h"
#include "common/rt/clock.h"
#include "common/user_error.h"

namespace bonemill {
namespace {

// Holds an open memory file until DeviceLink takes it over.
class File {
  public:
    explicit File(int descriptor) noexcept : descriptor_(descriptor) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() {
        if (descriptor_ >= 0) close(descriptor_);
    }
    int get() const noexcept { return descriptor_; }
    int release() noexcept { return std::exchange(descriptor_, -1); }

  private:
    int descriptor_;
};

LinkLockByte lockByteOf(LinkSide side) noexcept {
    return side == LinkSide::kServer ? kLockServer : kLockDaemon;
}
LinkSide peerOf(LinkSide side) noexcept {
    return side == LinkSide::kServer ? LinkSide::kDaemon : LinkSide::kServer;
}
const char* programOf(LinkSide side) noexcept {
    return side == LinkSide::kServer ? "haptic_server" : "device_daemon";
}

struct flock lockOf(LinkLockByte byte, short type) noexcept {
    struct flock lock {};
    lock.l_type = type;
    lock.l_whence = SEEK_SET;
    lock.l_start = byte;
    lock.l_len = 1;
    return lock;
}

bool tryLock(int file, LinkLockByte byte) noexcept {
    struct flock lock = lockOf(byte, F_WRLCK);
    return fcntl(file, F_OFD_SETLK, &lock) == 0;
}

// Others hold it for the microseconds of a set-up only.
void lockSetup(int file) noexcept {
    struct flock lock = lockOf(kLockSetup, F_WRLCK);
    while (fcntl(file, F_OFD_SETLKW, &lock) != 0 && errno == EINTR) {
    }
}

void unlockSetup(int file) noexcept {
    struct flock lock = lockOf(kLockSetup, F_UNLCK);
    fcntl(file, F_OFD_SETLK, &lock);
}

// Tells whether another open file, that is a living process, holds the byte.
bool isHeldByOther(int file, LinkLockByte byte) noexcept {
    struct flock lock = lockOf(byte, F_WRLCK);
    return fcntl(file, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

[[noreturn]] void fail(const std::string& name, const std::string& what) {
    throw UserError("device link /dev/shm" + name + ": " + what);
}

int openMemory(const std::string& name) {
    const int file = shm_open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file >= 0) return file;
    const std::string reason = std::strerror(errno);
    if (errno == EACCES)
        fail(name, reason + ": it belongs to another user; choose another --session or remove it");
    fail(name, "cannot be opened: " + reason);
}

// Tells whether the peer removed the file after we opened it: what we hold has no name any more.
bool isUnlinked(int file) noexcept {
    struct stat status {};
    return fstat(file, &status) != 0 || status.st_nlink == 0;
}

struct LinkHeader {
    uint64_t magic;
    uint32_t layout_version;
    uint32_t size;
};

LinkHeader readHeader(const std::string& name, int file) {
    LinkHeader header{};
    const ssize_t got = pread(file, &header, sizeof(header), 0);
    if (got != 0 && got != ssize_t(sizeof(header)))
        fail(name, "is not a bonemill device link; remove it or choose another --session");
    return header;
}

// Starts memory anew behind which nobody lives, unless it is not ours to erase. Magic 0 says that it is new,
// or that its maker died early.
void takeOver(const std::string& name, int file) {
    const LinkHeader header = readHeader(name, file);
    if (header.magic != kLinkMagic && header.magic != 0) {
        fail(name,
             "is not a bonemill device link (wrong magic number); remove it or choose another --session");
    }
    int error = ftruncate(file, 0) == 0 ? 0 : errno;
    if (!error) error = posix_fallocate(file, 0, sizeof(LinkMemory));
    if (error) fail(name, std::string("cannot be given its size: ") + std::strerror(error));
}

void checkLiving(const std::string& name, int file, LinkSide side) {
    const LinkHeader header = readHeader(name, file);
    struct stat status {};
    const std::string peer = programOf(peerOf(side));
    if (header.magic != kLinkMagic) {
        fail(name,
             "is not a bonemill device link (wrong magic number); stop the program that uses it, or choose "
             "another --session");
    }
    if (header.layout_version != kLinkLayoutVersion) {
        fail(name, "has layout version " + std::to_string(header.layout_version) + ", this " +
                       programOf(side) + " needs " + std::to_string(kLinkLayoutVersion) + ": run " + peer +
                       " of the same release");
    }
    if (header.size != sizeof(LinkMemory) || fstat(file, &status) != 0 ||
        size_t(status.st_size) < sizeof(LinkMemory)) {
        fail(name, "has a wrong size: stop " + peer + " and start it again");
    }
}

LinkMemory* mapMemory(const std::string& name, int file) {
    void* const memory = mmap(nullptr, sizeof(LinkMemory), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (memory == MAP_FAILED) fail(name, std::string("cannot be mapped: ") + std::strerror(errno));
    return static_cast<LinkMemory*>(memory);
}

LinkMemory* setUp(const std::string& name, int file, LinkSide side) {
    if (!tryLock(file, lockByteOf(side))) {
        fail(name, std::string("another ") + programOf(side) +
                       " uses this session; stop it or choose another --session");
    }
    if (isHeldByOther(file, lockByteOf(peerOf(side)))) {
        checkLiving(name, file, side);
        return mapMemory(name, file);
    }
    takeOver(name, file);
    LinkMemory* const memory = new (mapMemory(name, file)) LinkMemory{};
    memory->layout_version = kLinkLayoutVersion;
    memory->size = sizeof(LinkMemory);
    memory->magic = kLinkMagic;
    return memory;
}

LinkPeer& slotOf(LinkMemory& memory, LinkSide side) noexcept {
    return side == LinkSide::kServer ? memory.server : memory.daemon;
}

// Returns false when the deadline passed, and at once when the word is no longer `expected`.
bool futexWait(const std::atomic<uint32_t>& word, uint32_t expected, int64_t deadline_ns) noexcept {
    const timespec deadline = timespecOfNs(std::max<int64_t>(deadline_ns, 0));
    const long result =
        syscall(SYS_futex, &word, FUTEX_WAIT_BITSET, expected, &deadline, nullptr, FUTEX_BITSET_MATCH_ANY);
    return result == 0 || errno == EAGAIN || errno == EINTR;
}

void futexWake(const std::atomic<uint32_t>& word) noexcept {
    syscall(SYS_futex, &word, FUTEX_WAKE, INT32_MAX);
}

template <class Message>
uint64_t publish(LinkChannel<Message>& channel, LinkPeer& self, Message& message) noexcept {
    message.sequence = self.last_sequence.load(std::memory_order_relaxed) + 1;
    self.last_sequence.store(message.sequence, std::memory_order_relaxed);
    channel.value.write(message);
    // Read-modify-writes of is_awaited have one order: if the reader's comes after this one it acquires the
    // new counter and does not sleep, else this one sees its 1. No wake is lost.
    if (channel.is_awaited.exchange(0, std::memory_order_acq_rel)) futexWake(channel.value.counter());
    return message.sequence;
}

bool isComplete(uint32_t version) noexcept {
    return (version & 1u) == 0;
}

template <class Message>
bool waitForNewer(LinkChannel<Message>& channel, uint32_t read_version, int64_t deadline_ns) noexcept {
    const std::atomic<uint32_t>& counter = channel.value.counter();
    uint32_t version = counter.load(std::memory_order_acquire);
    for (bool is_time_left = true; is_time_left && (version == read_version || !isComplete(version));) {
        channel.is_awaited.exchange(1, std::memory_order_acq_rel);
        is_time_left = futexWait(counter, version, deadline_ns);  // returns at once if the counter moved on
        version = counter.load(std::memory_order_acquire);
    }
    channel.is_awaited.store(0, std::memory_order_relaxed);
    return version != read_version && isComplete(version);
}

}  // namespace

DeviceLink DeviceLink::create(uint32_t session, LinkSide side, uint64_t scene_hash) {
    const std::string name = "/bonemill_" + std::to_string(session);
    constexpr int kAttempts = 100;  // each lost one means that a peer left in this very moment
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        File file(openMemory(name));
        lockSetup(file.get());
        if (isUnlinked(file.get())) continue;
        LinkMemory* const memory = setUp(name, file.get(), side);
        const uint64_t scene_of_peer =
            slotOf(*memory, peerOf(side)).scene_hash.load(std::memory_order_relaxed);
        if (isHeldByOther(file.get(), lockByteOf(peerOf(side))) && scene_of_peer != scene_hash) {
            munmap(memory, sizeof(LinkMemory));
            fail(name, std::string(programOf(peerOf(side))) + " has read another scene than this " +
                           programOf(side) +
                           ": start both with the same --scene, or choose another --session");
        }
        slotOf(*memory, side).scene_hash.store(scene_hash, std::memory_order_relaxed);
        DeviceLink link(name, side, file.release(), memory);
        unlockSetup(link.file_);
        return link;
    }
    fail(name, "is created and removed again and again by other processes");
}

DeviceLink::DeviceLink(std::string name, LinkSide side, int file, LinkMemory* memory) noexcept
    : name_(std::move(name)), side_(side), file_(file), memory_(memory) {
    LinkPeer& self = slotOf(*memory_, side_);
    self.pid.store(getpid(), std::memory_order_relaxed);
    self.heartbeat_ns.store(monotonicNowNs(), std::memory_order_relaxed);
    // A predecessor may have died asleep.
    auto& own_wait = side_ == LinkSide::kServer ? memory_->sample.is_awaited : memory_->command.is_awaited;
    own_wait.store(0, std::memory_order_relaxed);
}

DeviceLink::DeviceLink(DeviceLink&& other) noexcept
    : name_(std::move(other.name_)),
      side_(other.side_),
      file_(std::exchange(other.file_, -1)),
      memory_(std::exchange(other.memory_, nullptr)),
      read_version_(other.read_version_),
      capabilities_version_(other.capabilities_version_) {}

DeviceLink::~DeviceLink() {
    if (!memory_) return;
    slotOf(*memory_, side_).pid.store(0, std::memory_order_relaxed);
    munmap(memory_, sizeof(LinkMemory));
    lockSetup(file_);
    if (!peerIsAlive() && !isUnlinked(file_)) shm_unlink(name_.c_str());
    close(file_);
}

uint64_t DeviceLink::writeSample(DeviceSample sample) noexcept {
    beat(sample.stamp_ns);
    return publish(memory_->sample, memory_->daemon, sample);
}

bool DeviceLink::readSample(DeviceSample& sample) noexcept {
    return memory_->sample.value.tryRead(sample, &read_version_);
}

bool DeviceLink::waitForSample(int64_t deadline_ns) noexcept {
    return waitForNewer(memory_->sample, read_version_, deadline_ns);
}

uint64_t DeviceLink::writeCommand(WrenchCommand command) noexcept {
    beat(command.stamp_ns);
    return publish(memory_->command, memory_->server, command);
}

bool DeviceLink::readCommand(WrenchCommand& command) noexcept {
    return memory_->command.value.tryRead(command, &read_version_);
}

void DeviceLink::writeCapabilities(const DeviceCapabilities& capabilities) noexcept {
    memory_->capabilities.value.write(capabilities);
}

bool DeviceLink::readCapabilities(DeviceCapabilities& capabilities) noexcept {
    uint32_t version = 0;
    DeviceCapabilities newest;
    if (!memory_->capabilities.value.tryRead(newest, &version) || version == capabilities_version_)
        return false;
    capabilities_version_ = version;
    capabilities = newest;
    return true;
}

bool DeviceLink::waitForCommand(int64_t deadline_ns) noexcept {
    return waitForNewer(memory_->command, read_version_, deadline_ns);
}

void DeviceLink::beat(int64_t now_ns) noexcept {
    slotOf(*memory_, side_).heartbeat_ns.store(now_ns, std::memory_order_relaxed);
}

int64_t DeviceLink::peerHeartbeatNs() const noexcept {
    return slotOf(*memory_, peerOf(side_)).heartbeat_ns.load(std::memory_order_relaxed);
}

int32_t DeviceLink::peerPid() const noexcept {
    return slotOf(*memory_, peerOf(side_)).pid.load(std::memory_order_relaxed);
}

bool DeviceLink::peerIsAlive() const noexcept {
    return isHeldByOther(file_, lockByteOf(peerOf(side_)));
}

}  // namespace bonemill

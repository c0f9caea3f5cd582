#include "common/ipc/device_link.h"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <string>
#include <utility>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/ipc/link_layout.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

// So long start and end wait for another process that starts or ends, which takes it microseconds.
constexpr int64_t kPatience_ns = 2 * kNsPerSecond;

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
        // It returns at once if the counter moved on, which a hostile writer may let it do for ever.
        is_time_left = futexWait(counter, version, deadline_ns) && monotonicNowNs() < deadline_ns;
        version = counter.load(std::memory_order_acquire);
    }
    channel.is_awaited.store(0, std::memory_order_relaxed);
    return version != read_version && isComplete(version);
}

LinkSemaphores beginSetup(const LinkPlace& place, int64_t deadline_ns) {
    LinkSemaphores semaphores = LinkSemaphores::open(place);
    while (!semaphores.beginSetup(deadline_ns)) {
        if (monotonicNowNs() >= deadline_ns) {
            place.refuse("process " + std::to_string(semaphores.pidInSetup()) +
                         " is stuck while it starts or ends there: stop it, or choose another --session");
        }
        semaphores = LinkSemaphores::open(place);  // the last to leave has removed the set
    }
    return semaphores;
}

// Ends the set-up when it goes, and gives the side back unless the link has come about.
class Setup {
  public:
    Setup(LinkSemaphores semaphores, LinkSide side) noexcept
        : semaphores_(semaphores), side_(side), owns_side_(semaphores_.tryTake(side_)) {}
    Setup(const Setup&) = delete;
    Setup& operator=(const Setup&) = delete;
    ~Setup() {
        if (owns_side_) semaphores_.giveBack(side_);
        semaphores_.endSetup();
    }
    bool ownsSide() const noexcept { return owns_side_; }
    void leaveSideToLink() noexcept { owns_side_ = false; }

  private:
    LinkSemaphores semaphores_;
    LinkSide side_;
    bool owns_side_;
};

}  // namespace

DeviceLink DeviceLink::create(uint32_t session, LinkSide side) {
    const LinkPlace place(session);
    const LinkSemaphores semaphores = beginSetup(place, monotonicNowNs() + kPatience_ns);
    Setup setup(semaphores, side);
    if (!setup.ownsSide()) {
        place.refuse(std::string("another ") + programOf(side) + " (process " +
                     std::to_string(semaphores.pidOf(side)) +
                     ") uses it; stop that one or choose another --session");
    }
    LinkSegment memory =
        semaphores.isTaken(peerOf(side)) ? LinkSegment::join(place, side) : LinkSegment::make(place);
    setup.leaveSideToLink();
    return {side, semaphores, std::move(memory)};
}

DeviceLink::DeviceLink(LinkSide side, LinkSemaphores semaphores, LinkSegment memory) noexcept
    : side_(side), semaphores_(semaphores), memory_(std::move(memory)) {
    beat(monotonicNowNs());
    // A predecessor may have died asleep.
    auto& own_wait = side_ == LinkSide::kServer ? memory_->sample.is_awaited : memory_->command.is_awaited;
    own_wait.store(0, std::memory_order_relaxed);
}

DeviceLink::~DeviceLink() {
    if (!memory_) return;
    const bool is_alone = semaphores_.beginSetup(monotonicNowNs() + kPatience_ns);
    semaphores_.giveBack(side_);
    if (!is_alone) return;
    if (!peerIsAlive()) memory_.remove();
    semaphores_.endSetup();
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

uint32_t DeviceLink::announceScene(const std::string& absolute_path, uint64_t hash, uint64_t epoch) {
    SceneNotice notice{};
    if (absolute_path.size() >= sizeof notice.path)
        throw UserError(absolute_path + ": the path is too long for device_daemon to be told of; " +
                        std::to_string(sizeof notice.path - 1) + " letters at most");
    memory_->scene.value.tryRead(notice);
    const uint32_t revision = notice.revision + 1 == 0 ? 1 : notice.revision + 1;
    const uint32_t attempt_changes = notice.attempt_changes + notice.attempt_changes % 2;
    const uint32_t hand_repeats = notice.hand_repeats;
    notice = {};
    notice.hash = hash;
    notice.epoch = epoch;
    notice.revision = revision;
    notice.attempt_changes = attempt_changes;
    notice.hand_repeats = hand_repeats;
    std::copy(absolute_path.begin(), absolute_path.end(), notice.path);
    capabilities_version_ = 0;  // who reads for the new scene knows no device yet
    memory_->scene.value.write(notice);
    return revision;
}

void DeviceLink::announceAttempt(bool begins) {
    SceneNotice notice{};
    if (!memory_->scene.value.tryRead(notice) || notice.revision == 0) return;
    const bool is_running = notice.attempt_changes % 2 == 1;
    if (!begins && !is_running) return;
    notice.attempt_changes += begins && is_running ? 2 : 1;
    memory_->scene.value.write(notice);
}

void DeviceLink::announceHand(HandChoice hand) {
    SceneNotice notice{};
    if (!memory_->scene.value.tryRead(notice) || notice.revision == 0) return;
    notice.hand = uint32_t(hand);
    if (hand == HandChoice::kOwn) ++notice.hand_repeats;
    memory_->scene.value.write(notice);
}

bool DeviceLink::readScene(SceneNotice& notice) const noexcept {
    SceneNotice newest;
    if (!memory_->scene.value.tryRead(newest) || !isPlausible(newest)) return false;
    notice = newest;
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

bool DeviceLink::peerIsAlive() const noexcept {
    return semaphores_.isTaken(peerOf(side_));
}

}  // namespace bonemill

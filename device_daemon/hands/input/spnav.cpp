#include "device_daemon/hands/input/spnav.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr int32_t kMotion = 0, kPress = 1, kRelease = 2, kDeviceChange = 3;
constexpr uint32_t kProtocolMask = 0xffffff00;
constexpr int kLastButton = 31;

// A word of the message; `index` counts words.
int32_t wordOf(std::span<const std::byte> message, size_t index) noexcept {
    int32_t word;
    std::memcpy(&word, message.data() + index * sizeof word, sizeof word);
    return word;
}

bool isProtocolAnswer(int32_t word) noexcept {
    return (static_cast<uint32_t>(word) & kProtocolMask) ==
           (static_cast<uint32_t>(SpnavStream::kAskForProtocol1) & kProtocolMask);
}

constexpr int64_t kLongestProbeNs = 500 * kNsPerMillisecond;

bool sendAll(int socket, const void* data, size_t size) {
    return send(socket, data, size, MSG_NOSIGNAL) == static_cast<ssize_t>(size);
}

// Returns false when nothing more comes.
bool readInto(SpnavStream& stream, int socket, int64_t deadline_ns) {
    const int64_t left_ns = deadline_ns - monotonicNowNs();
    if (left_ns <= 0) return false;
    pollfd events{.fd = socket, .events = POLLIN, .revents = 0};
    if (poll(&events, 1, static_cast<int>(left_ns / kNsPerMillisecond) + 1) <= 0) return false;
    std::array<std::byte, 1024> bytes;
    const ssize_t size = read(socket, bytes.data(), bytes.size());
    if (size <= 0) return false;
    stream.take(std::span(bytes).first(static_cast<size_t>(size)));
    return true;
}

SpnavState probeSocket(int socket) {
    SpnavStream stream;
    const int64_t deadline_ns = monotonicNowNs() + kLongestProbeNs;
    if (!askForProtocol(socket)) return SpnavState::kSilent;
    while (!stream.hasAnswered() && readInto(stream, socket, deadline_ns)) {
    }
    if (stream.protocol() == 0) return SpnavState::kReady;
    if (!askForDevice(socket)) return SpnavState::kSilent;
    while (!stream.hasToldOfDevice() && readInto(stream, socket, deadline_ns)) {
    }
    if (!stream.hasToldOfDevice()) return SpnavState::kSilent;
    return stream.hasDevice() ? SpnavState::kReady : SpnavState::kNoDevice;
}

}  // namespace

bool SpnavStream::hasChangedDevices() noexcept {
    return std::exchange(has_changed_devices_, false);
}

void SpnavStream::take(std::span<const std::byte> bytes) noexcept {
    for (const std::byte byte : bytes) {
        message_[filled_++] = byte;
        if (!has_answered_ && filled_ == sizeof(int32_t) && isProtocolAnswer(wordOf(message_, 0))) {
            has_answered_ = true;
            protocol_ = wordOf(message_, 0) & 0xff;
            filled_ = 0;
        } else if (filled_ == kMessageSize) {
            takeMessage();
            filled_ = 0;
        }
    }
}

void SpnavStream::takeMessage() noexcept {
    const int32_t type = wordOf(message_, 0);
    if (type == kMotion) {
        for (size_t i = 0; i < counts_.size(); ++i) counts_[i] = wordOf(message_, i + 1);
    } else if (type == kPress || type == kRelease) {
        const int32_t button = wordOf(message_, 1);
        if (button < 0) return;
        const uint32_t bit = 1u << std::min(button, kLastButton);
        buttons_ = type == kPress ? buttons_ | bit : buttons_ & ~bit;
    } else if (type == kDeviceChange) {
        has_changed_devices_ = true;
        release();
    } else if (type == kAskForDevice[0]) {
        has_told_of_device_ = true;
        has_device_ = wordOf(message_, 7) == 0;
        if (!has_device_) release();
    }
}

// What an unplugged device was doing when it was last heard, it does no longer.
void SpnavStream::release() noexcept {
    counts_.fill(0);
    buttons_ = 0;
}

std::string spnavSocketPath() {
    const char* path = getenv("SPNAV_SOCKET");
    return path && *path ? path : "/var/run/spnav.sock";
}

int connectSpnav(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.size() >= sizeof address.sun_path) {
        errno = ENAMETOOLONG;
        return -1;
    }
    path.copy(address.sun_path, path.size());
    const int file = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (file < 0) return -1;
    if (connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return file;
    const int error = errno;
    close(file);
    errno = error;
    return -1;
}

bool askForProtocol(int socket) {
    return sendAll(socket, &SpnavStream::kAskForProtocol1, sizeof SpnavStream::kAskForProtocol1);
}

bool askForDevice(int socket) {
    return sendAll(socket, SpnavStream::kAskForDevice.data(), sizeof SpnavStream::kAskForDevice);
}

SpnavState probeSpnav(const std::string& path) {
    const int socket = connectSpnav(path);
    if (socket < 0) {
        if (errno == ENOENT) return SpnavState::kNoSocket;
        return errno == EACCES || errno == EPERM ? SpnavState::kForbidden : SpnavState::kSilent;
    }
    const SpnavState state = probeSocket(socket);
    close(socket);
    return state;
}

}  // namespace bonemill

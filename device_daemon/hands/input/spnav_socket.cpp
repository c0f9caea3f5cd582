#include "device_daemon/hands/input/spnav_socket.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

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

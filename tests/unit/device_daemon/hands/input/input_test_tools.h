// Devices for tests of hands: pipes that speak like the kernel's input files, and a spacenavd on a socket of
// its own.
#pragma once

#include <fcntl.h>
#include <linux/input.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "device_daemon/hands/input/gamepad_device.h"
#include "device_daemon/hands/input/spnav.h"

namespace bonemill::test {

// Returns false when it has not come true after a time that is long for any machine.
inline bool comesTrue(const std::function<bool()>& holds) {
    for (int i = 0; i < 30000 && !holds(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return holds();
}

template <class T>
std::span<const std::byte> bytesOf(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

inline input_event inputEvent(int type, int code, int value) {
    input_event event{};
    event.type = static_cast<uint16_t>(type);
    event.code = static_cast<uint16_t>(code);
    event.value = value;
    return event;
}

// What a pad with a driver of its own in the kernel looks like.
inline EvdevState padState() {
    EvdevState state;
    for (const int axis : {ABS_X, ABS_Y, ABS_RX, ABS_RY}) state.axes[axis] = {.min = -32768, .max = 32767};
    for (const int axis : {ABS_Z, ABS_RZ}) state.axes[axis] = {.max = 255};
    state.axes[ABS_HAT0X] = {.min = -1, .max = 1};
    return state;
}

// An input device at the other end of a pipe. It can be unplugged, and plugged in again.
class PipedInput {
  public:
    explicit PipedInput(const EvdevState& state = padState()) : state_(state) {}
    ~PipedInput() { unplug(); }

    // For the device under test, which must not live longer than this.
    EvdevOpener opener() {
        return [this]() -> std::optional<EvdevDevice> {
            const int file = pending_.exchange(-1);
            if (file < 0) return std::nullopt;
            return EvdevDevice{.file = file, .name = "piped pad", .state = state_};
        };
    }
    void plugIn() {
        std::array<int, 2> ends;
        if (pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC) != 0) std::abort();
        writing_ = ends[1];
        pending_ = ends[0];
    }
    void unplug() {
        if (const int file = std::exchange(writing_, -1); file >= 0) close(file);
        if (const int file = pending_.exchange(-1); file >= 0) close(file);
    }
    void write(std::span<const std::byte> bytes) const {
        if (::write(writing_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) std::abort();
    }
    void send(int type, int code, int value) const {
        write(bytesOf(inputEvent(type, code, value)));
        write(bytesOf(inputEvent(EV_SYN, SYN_REPORT, 0)));
    }

  private:
    EvdevState state_;
    int writing_ = -1;
    std::atomic<int> pending_ = -1;  // the end that the next opener gets
};

// Speaks spacenavd's wire to one client at a time.
class FakeSpacenavd {
  public:
    FakeSpacenavd(const std::string& path, int protocol, bool has_device)
        : path_(path), protocol_(protocol), has_device_(has_device) {
        listening_ = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path.copy(address.sun_path, sizeof address.sun_path - 1);
        if (bind(listening_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
            listen(listening_, 4) != 0)
            std::abort();
        thread_ = std::thread([this] { serve(); });
    }
    ~FakeSpacenavd() {
        should_stop_ = true;
        thread_.join();
        if (client_ >= 0) close(client_);
        close(listening_);
        unlink(path_.c_str());
    }

    bool hasClient() const { return is_greeted_; }
    float sensitivity() const { return sensitivity_; }
    void setDevice(bool has_device) { has_device_ = has_device; }
    void send(const std::array<int32_t, 8>& message) const {
        // A client that is gone hears nothing.
        [[maybe_unused]] const auto sent = ::send(client_, message.data(), sizeof message, MSG_NOSIGNAL);
    }

  private:
    void serve() {
        while (!should_stop_) {
            pollfd events{.fd = client_ >= 0 ? client_.load() : listening_, .events = POLLIN, .revents = 0};
            if (poll(&events, 1, 5) <= 0) continue;
            if (client_ < 0) {
                client_ = accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
            } else if (!answer()) {
                is_greeted_ = false;
                close(client_.exchange(-1));
            }
        }
    }

    // An old spacenavd takes the question for the protocol as a sensitivity, and says nothing.
    bool answer() {
        if (!is_greeted_) {
            int32_t word = 0;
            if (recv(client_, &word, sizeof word, MSG_WAITALL) != sizeof word) return false;
            if (protocol_ > 0) ::send(client_, &word, sizeof word, MSG_NOSIGNAL);
            is_greeted_ = true;
            return true;
        }
        if (protocol_ == 0) {
            float value = 0;
            if (recv(client_, &value, sizeof value, MSG_WAITALL) != sizeof value) return false;
            sensitivity_ = value;
            return true;
        }
        SpnavStream::Request request{};
        if (recv(client_, request.data(), sizeof request, MSG_WAITALL) != sizeof request) return false;
        request[7] = has_device_ ? 0 : -1;
        send(request);
        return true;
    }

    const std::string path_;
    const int protocol_;
    std::atomic<bool> has_device_;
    std::atomic<bool> should_stop_ = false;
    std::atomic<bool> is_greeted_ = false;
    std::atomic<float> sensitivity_ = 0;
    std::atomic<int> client_ = -1;
    int listening_ = -1;
    std::thread thread_;
};

}  // namespace bonemill::test

#include "device_daemon/hands/input/input_reader.h"

#include <errno.h>
#include <poll.h>
#include <unistd.h>

#include <array>

namespace bonemill {

InputReader::~InputReader() {
    should_stop_ = true;
    thread_.join();
}

void InputReader::run() {
    while (!should_stop_) {
        const int file = source_.open();
        if (file >= 0) {
            readUntilLost(file);
            source_.lost();
            close(file);
        }
        for (auto waited = kRest; waited < kRetry && !should_stop_; waited += kRest)
            std::this_thread::sleep_for(kRest);
    }
}

void InputReader::readUntilLost(int file) {
    std::array<std::byte, 4096> bytes;
    while (!should_stop_) {
        pollfd events{.fd = file, .events = POLLIN, .revents = 0};
        poll(&events, 1, static_cast<int>(kRest.count()));
        // What came before the end is still read; the end itself reads as 0 bytes or an error.
        if (events.revents != 0) {
            const ssize_t size = read(file, bytes.data(), bytes.size());
            const bool is_end = size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR);
            if (is_end) return;
            if (size > 0 && !source_.take(std::span(bytes).first(static_cast<size_t>(size)))) return;
        }
        if (!source_.rest()) return;
    }
}

}  // namespace bonemill

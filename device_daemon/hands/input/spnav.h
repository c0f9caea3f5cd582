// Finds and opens spacenavd's socket, and understands what it says. It makes system calls and is not for the
// loop.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace bonemill {

// Reads what spacenavd writes on its socket: messages of eight 32-bit integers in the machine's own order,
// in whatever pieces they arrive.
//
// We speak this wire ourselves rather than through libspnav, because libspnav has one connection per process,
// takes a truncated message for a whole one, falls back to another socket when the named one is silent, and
// brings X11 along. Protocol 1 tells when the device is unplugged; protocol 0 (spacenavd up to 0.8) does not.
// It is a plain value for one thread, and no bytes break it.
class SpnavStream {
  public:
    static constexpr size_t kMessageSize = 32;
    using Request = std::array<int32_t, 8>;

    // Four bytes that ask for protocol 1; the same bytes are the answer.
    static constexpr int32_t kAskForProtocol1 = 0x7faa5501;
    // Asks what kind of device there is, in protocol 1. The answer fails while there is none.
    static constexpr Request kAskForDevice{0x7faa2005};

    void take(std::span<const std::byte> bytes) noexcept;

    bool hasAnswered() const noexcept { return has_answered_; }  // to kAskForProtocol1
    int protocol() const noexcept { return protocol_; }
    // Something was plugged in or unplugged since the last call: ask for the device again.
    bool hasChangedDevices() noexcept;
    bool hasToldOfDevice() const noexcept { return has_told_of_device_; }
    bool hasDevice() const noexcept { return has_device_; }

    // x right, y up, z into the picture, and the rotations about these; in the device's own units.
    const std::array<int32_t, 6>& counts() const noexcept { return counts_; }
    // Bit n: button n is pressed. Buttons above 31 are not told apart from 31.
    uint32_t buttons() const noexcept { return buttons_; }

  private:
    void takeMessage() noexcept;
    void release() noexcept;

    std::array<std::byte, kMessageSize> message_;
    size_t filled_ = 0;
    bool has_answered_ = false;
    int protocol_ = 0;
    bool has_changed_devices_ = false;
    bool has_told_of_device_ = false;
    bool has_device_ = false;
    std::array<int32_t, 6> counts_{};
    uint32_t buttons_ = 0;
};

// Returns what the environment variable SPNAV_SOCKET says, or else spacenavd's own place.
std::string spnavSocketPath();

// Returns a connected socket that never blocks, or -1 with errno.
int connectSpnav(const std::string& path);

// They return false when the socket takes nothing.
bool askForProtocol(int socket);
bool askForDevice(int socket);

// What --list wants to know.
enum class SpnavState {
    kNoSocket,   // spacenavd is not installed, or does not run
    kForbidden,  // the socket may not be opened
    kSilent,     // no daemon listens behind the socket
    kNoDevice,   // it runs, and has no device
    kReady,
};
// Waits for spacenavd's answers, half a second at most. One that speaks protocol 0 counts as ready.
SpnavState probeSpnav(const std::string& path);

}  // namespace bonemill

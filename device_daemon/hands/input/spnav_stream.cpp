#include "device_daemon/hands/input/spnav_stream.h"

#include <algorithm>
#include <cstring>
#include <utility>

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

}  // namespace bonemill

#include "device_daemon/hands/input/evdev_device.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstring>
#include <numeric>

namespace bonemill {
namespace {

// The kernel's bit masks are arrays of long.
template <size_t Count>
class KernelBits {
  public:
    static constexpr size_t kSize =
        (Count + CHAR_BIT * sizeof(long) - 1) / (CHAR_BIT * sizeof(long)) * sizeof(long);

    void* data() { return words_.data(); }
    bool operator[](size_t bit) const {
        constexpr size_t kBitsPerWord = CHAR_BIT * sizeof(long);
        return (static_cast<unsigned long>(words_[bit / kBitsPerWord]) >> (bit % kBitsPerWord)) & 1;
    }

  private:
    std::array<long, kSize / sizeof(long)> words_{};
};

}  // namespace

double EvdevAxis::fromCentre() const noexcept {
    if (!exists()) return 0;
    const double middle = std::midpoint(double(min), double(max));
    return std::clamp((value - middle) / (max - middle), -1.0, 1.0);
}

void EvdevStream::take(std::span<const std::byte> bytes) noexcept {
    for (const std::byte byte : bytes) {
        event_[filled_++] = byte;
        if (filled_ < event_.size()) continue;
        input_event event;
        std::memcpy(&event, event_.data(), sizeof event);
        filled_ = 0;
        takeEvent(event);
    }
}

void EvdevStream::takeEvent(const input_event& event) noexcept {
    if (event.type == EV_SYN && event.code == SYN_DROPPED) {
        is_skipping_ = true;
    } else if (event.type == EV_SYN && event.code == SYN_REPORT) {
        needs_refresh_ |= is_skipping_;
        is_skipping_ = false;
    } else if (is_skipping_) {
        return;
    } else if (event.type == EV_KEY && event.code < KEY_CNT) {
        state_.keys[event.code] = event.value != 0;  // 2 is a repeated key
    } else if (event.type == EV_ABS && event.code < ABS_CNT) {
        state_.axes[event.code].value = event.value;
    }
}

bool refreshEvdev(int file, EvdevState& state) {
    KernelBits<KEY_CNT> keys;
    KernelBits<ABS_CNT> axes;
    // A device without keys or axes answers with none of them.
    if (ioctl(file, EVIOCGKEY(KernelBits<KEY_CNT>::kSize), keys.data()) < 0 ||
        ioctl(file, EVIOCGBIT(EV_ABS, KernelBits<ABS_CNT>::kSize), axes.data()) < 0)
        return false;
    for (size_t i = 0; i < KEY_CNT; ++i) state.keys[i] = keys[i];
    for (size_t i = 0; i < ABS_CNT; ++i) {
        input_absinfo axis{};
        if (!axes[i] || ioctl(file, EVIOCGABS(i), &axis) < 0) axis = {};
        state.axes[i] = {.value = axis.value, .min = axis.minimum, .max = axis.maximum};
    }
    return true;
}

bool takeEvents(int file, std::span<const std::byte> bytes, EvdevStream& stream) {
    stream.take(bytes);
    if (!stream.needsRefresh()) return true;
    EvdevState state;
    if (!refreshEvdev(file, state)) return false;
    stream.refresh(state);
    return true;
}

std::optional<EvdevDevice> openEvdev(const std::string& path, bool is_exclusive) {
    constexpr int kFlags = O_NONBLOCK | O_CLOEXEC;
    const int writable = open(path.c_str(), O_RDWR | kFlags);
    const int file = writable >= 0 ? writable : open(path.c_str(), O_RDONLY | kFlags);
    if (file < 0) return std::nullopt;
    std::array<char, 256> name{};
    EvdevDevice device;
    const bool is_input =
        ioctl(file, EVIOCGNAME(name.size() - 1), name.data()) >= 0 && refreshEvdev(file, device.state);
    if (!is_input || (is_exclusive && ioctl(file, EVIOCGRAB, 1) < 0)) {
        close(file);
        return std::nullopt;
    }
    KernelBits<FF_CNT> effects;
    device.has_rumble = writable >= 0 &&
                        ioctl(file, EVIOCGBIT(EV_FF, KernelBits<FF_CNT>::kSize), effects.data()) >= 0 &&
                        effects[FF_RUMBLE];
    device.file = file;
    device.name = name.data();
    return device;
}

}  // namespace bonemill

#include "device_daemon/hands/input/pedal_source.h"

#include "common/device_messages/device_messages.h"

namespace bonemill {

int PedalSource::open() {
    const auto device = opener_();
    if (!device) return -1;
    file_ = device->file;
    stream_ = EvdevStream(device->state);
    is_there_.store(true, std::memory_order_relaxed);
    tell();
    return file_;
}

bool PedalSource::take(std::span<const std::byte> bytes) {
    if (!takeEvents(file_, bytes, stream_)) return false;
    tell();
    return true;
}

void PedalSource::lost() {
    buttons_.store(0, std::memory_order_relaxed);
    is_there_.store(false, std::memory_order_relaxed);
}

void PedalSource::tell() noexcept {
    buttons_.store(stream_.state().keys.any() ? kButtonRemove : 0u, std::memory_order_relaxed);
}

}  // namespace bonemill

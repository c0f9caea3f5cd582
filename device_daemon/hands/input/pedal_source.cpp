#include "device_daemon/hands/input/pedal_source.h"

#include "common/base/user_error.h"
#include "common/device_messages/device_messages.h"

namespace bonemill {
namespace {

PedalKeys checked(const PedalKeys& keys) {
    for (const auto& code : {keys.remove, keys.add}) {
        if (code && *code >= KEY_CNT)
            throw UserError("no key has the code " + std::to_string(*code) + ": codes end at " +
                            std::to_string(KEY_MAX) + " (evtest shows that of a pedal)");
    }
    return keys;
}

}  // namespace

PedalSource::PedalSource(const std::string& path, const PedalKeys& keys, bool is_exclusive)
    : PedalSource([path, is_exclusive] { return openEvdev(path, is_exclusive); }, keys) {}

PedalSource::PedalSource(EvdevOpener opener, const PedalKeys& keys)
    : opener_(std::move(opener)), keys_(checked(keys)), reader_(*this) {}

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
    auto keys = stream_.state().keys;
    const bool adds = keys_.add && keys[*keys_.add];
    if (keys_.add) keys.reset(*keys_.add);
    const bool removes = keys_.remove ? keys[*keys_.remove] : keys.any();
    buttons_.store((removes ? kButtonRemove : 0u) | (adds ? kButtonAdd : 0u), std::memory_order_relaxed);
}

}  // namespace bonemill

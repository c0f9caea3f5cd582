#include "device_daemon/hands/input/spacemouse_device.h"

#include <sys/socket.h>

#include <algorithm>
#include <cmath>

#include "common/rt/clock.h"
#include "device_daemon/hands/input/spnav.h"

namespace bonemill {
namespace {

// A spacenavd that has not answered by then speaks protocol 0.
constexpr int64_t kProtocolAnswerNs = 250 * kNsPerMillisecond;
// The buttons that mean something, as masks of SpnavStream::buttons().
constexpr uint32_t kRemoveButton = 1u << 0, kAddButton = 1u << 1, kFineButtons = ~3u;
constexpr float kPlainSensitivity = 1;
// spacenavd's z goes into the picture, ours out of it.
constexpr std::array<float, 6> kSigns{1, 1, -1, 1, 1, -1};

}  // namespace

float FullScale::shareOf(int32_t counts) noexcept {
    const float value = static_cast<float>(counts);
    if (std::abs(value) > kMaxCounts) return 0;
    full_counts_ = std::max(full_counts_, std::abs(value));
    return value / full_counts_;
}

SpaceMouseDevice::SpaceMouseDevice(const RateConfig& config, const Pose& X_DT_start, std::string socket_path)
    : RateDevice(DeviceKind::kSpaceMouse, "SpaceMouse", config, X_DT_start),
      path_(socket_path.empty() ? spnavSocketPath() : std::move(socket_path)),
      reader_(*this) {}

int SpaceMouseDevice::open() {
    socket_ = connectSpnav(path_);
    if (socket_ < 0) return -1;
    stream_ = {};
    full_scale_ = {};
    is_settled_ = false;
    opened_ns_ = monotonicNowNs();
    askForProtocol(socket_);  // if that fails, so does reading
    return socket_;
}

bool SpaceMouseDevice::take(std::span<const std::byte> bytes) {
    stream_.take(bytes);
    if (stream_.hasAnswered() && !is_settled_) {
        is_settled_ = true;
        if (stream_.protocol() > 0 && !askForDevice(socket_)) return false;
    }
    if (is_settled_ && stream_.hasChangedDevices() && !askForDevice(socket_)) return false;
    tell();
    return true;
}

// To protocol 0 our question was a sensitivity; it gets a proper one.
bool SpaceMouseDevice::rest() {
    if (is_settled_ || monotonicNowNs() - opened_ns_ < kProtocolAnswerNs) return true;
    is_settled_ = true;
    const bool is_sent =
        send(socket_, &kPlainSensitivity, sizeof kPlainSensitivity, MSG_NOSIGNAL) == sizeof kPlainSensitivity;
    if (is_sent) tell();
    return is_sent;
}

void SpaceMouseDevice::lost() {
    publish({});
    was_there_ = false;
}

void SpaceMouseDevice::tell() {
    const bool is_there = is_settled_ && (stream_.protocol() == 0 || stream_.hasDevice());
    if (is_there && !was_there_) takeName("SpaceMouse");
    was_there_ = is_there;
    HandInput input{};
    if (is_there) {
        for (size_t i = 0; i < kSigns.size(); ++i)
            input.deflections[i] = kSigns[i] * full_scale_.shareOf(stream_.counts()[i]);
        const uint32_t pressed = stream_.buttons();
        input.buttons =
            (pressed & kRemoveButton ? kButtonRemove : 0u) | (pressed & kAddButton ? kButtonAdd : 0u);
        input.is_fine = (pressed & kFineButtons) != 0;
        input.is_there = 1;
    }
    publish(input);
}

}  // namespace bonemill

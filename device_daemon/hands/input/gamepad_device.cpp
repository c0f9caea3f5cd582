#include "device_daemon/hands/input/gamepad_device.h"

#include "device_daemon/hands/input/gamepad_map.h"
#include "device_daemon/hands/input/input_scan.h"

namespace bonemill {

EvdevOpener gamepadAt(const std::string& path) {
    constexpr bool kIsExclusive = false;
    if (!path.empty()) return [path] { return openEvdev(path, kIsExclusive); };
    return []() -> std::optional<EvdevDevice> {
        for (const InputFact& fact : scanInputs()) {
            if (fact.role != InputRole::kGamepad) continue;
            if (auto device = openEvdev(fact.path, kIsExclusive)) return device;
        }
        return std::nullopt;
    };
}

GamepadDevice::GamepadDevice(const RateConfig& config, const Pose& X_DT_start, EvdevOpener opener)
    : RateDevice(DeviceKind::kGamepad, "gamepad", config, X_DT_start),
      opener_(std::move(opener)),
      reader_(*this) {}

int GamepadDevice::open() {
    const auto device = opener_();
    if (!device) return -1;
    file_ = device->file;
    stream_ = EvdevStream(device->state);
    motors_ = device->has_rumble ? RumbleMotors(file_) : RumbleMotors();
    takeName(device->name);
    publish(handInputOf(stream_.state()));
    return file_;
}

bool GamepadDevice::take(std::span<const std::byte> bytes) {
    if (!takeEvents(file_, bytes, stream_)) return false;
    publish(handInputOf(stream_.state()));
    return true;
}

bool GamepadDevice::rest() {
    const Felt now = felt();
    motors_.shake(rumbleOf(now.force, now.buttons & kButtonRemove));
    return true;
}

void GamepadDevice::lost() {
    publish({});
}

}  // namespace bonemill

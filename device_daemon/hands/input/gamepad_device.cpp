#include "device_daemon/hands/input/gamepad_device.h"

#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "common/device_messages/device_messages.h"
#include "common/rt/clock.h"
#include "device_daemon/hands/input/device_list.h"

namespace bonemill {
namespace {

constexpr double kFullLevel = 0xffff;
constexpr double kTurningShare = 0.15;  // of the weak motor while the burr turns in air
// Motors know no finer steps, and every change is a message to the gamepad.
constexpr uint16_t kStep = 0x0800;

uint16_t levelOf(double share) noexcept {
    return static_cast<uint16_t>(std::clamp(share, 0.0, 1.0) * kFullLevel) / kStep * kStep;
}

struct Sticks {
    double right_x, right_y;
    double right_trigger, left_trigger;  // 0 to 1
};

Sticks sticksOf(const EvdevState& state) noexcept {
    const auto& axes = state.axes;
    if (axes[ABS_RX].exists())
        return {axes[ABS_RX].fromCentre(), axes[ABS_RY].fromCentre(), axes[ABS_RZ].fromEnd(),
                axes[ABS_Z].fromEnd()};
    return {axes[ABS_Z].fromCentre(), axes[ABS_RZ].fromCentre(), double(state.keys[BTN_TR2]),
            double(state.keys[BTN_TL2])};
}

}  // namespace

RumbleLevel rumbleOf(double force, bool is_cutting) noexcept {
    const double share = force > RumbleMotors::kMinForce ? force / RumbleMotors::kFullForce : 0;
    return {.strong = levelOf(share), .weak = levelOf(is_cutting ? kTurningShare + share : 0)};
}

void RumbleMotors::shake(const RumbleLevel& level) noexcept {
    const int64_t now_ns = monotonicNowNs();
    const bool is_still = level == RumbleLevel{};
    const bool is_due = !is_still && now_ns - started_ns_ > kRefreshNs;
    if (file_ < 0 || (level == level_ && !is_due)) return;
    ff_effect effect{};
    effect.type = FF_RUMBLE;
    effect.id = static_cast<int16_t>(effect_);
    effect.u.rumble = {.strong_magnitude = level.strong, .weak_magnitude = level.weak};
    effect.replay.length = kEffectMs;
    // A gamepad that refuses just does not shake.
    if (ioctl(file_, EVIOCSFF, &effect) < 0) return;
    effect_ = effect.id;
    input_event play{};
    play.type = EV_FF;
    play.code = static_cast<uint16_t>(effect_);
    play.value = is_still ? 0 : 1;
    if (write(file_, &play, sizeof play) != sizeof play) return;
    level_ = level;
    started_ns_ = now_ns;
}

// Sticks count downwards and to the right.
HandInput handInputOf(const EvdevState& state) noexcept {
    const Sticks sticks = sticksOf(state);
    const std::array<double, 6> deflections{state.axes[ABS_X].fromCentre(),
                                            -state.axes[ABS_Y].fromCentre(),
                                            sticks.left_trigger - sticks.right_trigger,
                                            sticks.right_y,
                                            sticks.right_x,
                                            -state.axes[ABS_HAT0X].fromCentre()};
    HandInput input{};
    for (size_t i = 0; i < deflections.size(); ++i) input.deflections[i] = static_cast<float>(deflections[i]);
    input.buttons = (state.keys[BTN_SOUTH] ? kButtonRemove : 0u) | (state.keys[BTN_EAST] ? kButtonAdd : 0u);
    input.is_fine = state.keys[BTN_TL];
    input.is_there = 1;
    return input;
}

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

#include "device_daemon/hands/input/rumble.h"

#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr double kFullLevel = 0xffff;
constexpr double kTurningShare = 0.15;  // of the weak motor while the burr turns in air
// Motors know no finer steps, and every change is a message to the gamepad.
constexpr uint16_t kStep = 0x0800;

uint16_t levelOf(double share) noexcept {
    return static_cast<uint16_t>(std::clamp(share, 0.0, 1.0) * kFullLevel) / kStep * kStep;
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

}  // namespace bonemill

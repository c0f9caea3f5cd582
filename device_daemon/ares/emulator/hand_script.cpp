#include "device_daemon/ares/emulator/hand_script.h"

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr int64_t kSwitchReleasedNs = 50 * kNsPerMillisecond;
constexpr int64_t kSwitchEveryNs = 300 * kNsPerMillisecond;
constexpr int64_t kPatienceNs = 1000 * kNsPerMillisecond;  // with a host that does not engage
constexpr int64_t kResetAfterNs = 500 * kNsPerMillisecond;
constexpr int64_t kResetHeldNs = 50 * kNsPerMillisecond;

}  // namespace

void HandScript::update(const View& view, int64_t now_ns) noexcept {
    if (!has_begun_) quiet_since_ns_ = now_ns;
    has_begun_ = true;
    pressSwitchAnew(view, now_ns);
    pressResetInTrouble(view, now_ns);
}

void HandScript::pressSwitchAnew(const View& view, int64_t now_ns) noexcept {
    const bool must_press = view.drive == wire::DriveState::kOperationEnabled && !view.is_engaged;
    if (must_press && (!has_pressed_ || now_ns - switch_pressed_ns_ >= kSwitchEveryNs)) {
        switch_pressed_ns_ = now_ns;
        has_pressed_ = true;
    }
    holds_switch_ = has_pressed_ && now_ns - switch_pressed_ns_ >= kSwitchReleasedNs;
}

void HandScript::pressResetInTrouble(const View& view, int64_t now_ns) noexcept {
    const bool is_faulty = view.drive == wire::DriveState::kFault;
    if (view.is_engaged || is_faulty != was_faulty_) quiet_since_ns_ = now_ns;
    was_faulty_ = is_faulty;

    const int64_t patience_ns = is_faulty ? 0 : kPatienceNs;
    const int64_t pressed_for_ns = now_ns - quiet_since_ns_ - patience_ns - kResetAfterNs;
    presses_reset_ = pressed_for_ns >= 0 && pressed_for_ns < kResetHeldNs;
    if (pressed_for_ns >= kResetHeldNs) quiet_since_ns_ = now_ns;  // and wait again
}

}  // namespace bonemill

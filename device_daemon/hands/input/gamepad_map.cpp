#include "device_daemon/hands/input/gamepad_map.h"

#include "common/device_messages/device_messages.h"

namespace bonemill {
namespace {

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

}  // namespace bonemill

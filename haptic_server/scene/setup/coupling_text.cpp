#include "haptic_server/scene/setup/coupling_text.h"

#include <cstdio>

#include "common/base/units.h"
#include "haptic_server/core/tick/hand_side.h"

namespace bonemill {
namespace {

constexpr double kNearlyAll = 0.999;

std::string because(const HandleDynamics& handle) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        ", because the device declares %.3g kg, %.3g N·s/m, %.3g kg·mm², %.3g N·mm·s/rad and %.3g ms "
        "of delay",
        handle.mass, handle.damping, handle.inertia * kPerMillimetre * kPerMillimetre,
        handle.angular_damping * kPerMillimetre, handle.delay * kPerMillisecond);
    return text;
}

}  // namespace

std::string couplingText(const TickConfig& config, const DeviceCapabilities& device) {
    const HandSide wished = handSideOf(config), said = handSideOf(config, device),
                   fitted = fittedHandSide(config, device);
    const auto push = [&](const HandSide& side) {
        return config.hand_space.forcePerWayAtHand(side.gradient.translation_stiffness) / kPerMillimetre;
    };
    const auto turn = [&](const HandSide& side) {
        return config.hand_space.torqueAtHand(side.gradient.rotation_stiffness) * kPerMillimetre;
    };
    char text[200];
    std::snprintf(text, sizeof text, "coupling %.3g of %.3g N/mm and %.3g of %.3g N·mm/rad", push(said),
                  push(wished), turn(said), turn(wished));
    std::string line = text;
    if (!(device.handle.mass > 0) && !(device.handle.inertia > 0))
        return line + "; the device says nothing of its mass, and what energy is made is watched alone";
    const double share = fitted.gradient.relaxing_share;
    const bool is_softer = push(fitted) < kNearlyAll * push(said) || turn(fitted) < kNearlyAll * turn(said);
    if (share > said.gradient.relaxing_share) {
        std::snprintf(text, sizeof text, ", relaxing share %.3g for %.3g within %.3g ms", share,
                      said.gradient.relaxing_share, fitted.gradient.relaxing_time * kPerMillisecond);
        line += text;
    }
    if (is_softer) {
        std::snprintf(text, sizeof text, "; %.3g N/mm and %.3g N·mm/rad where no hand keeps it from swinging",
                      push(fitted), turn(fitted));
        line += text;
    }
    return is_softer || share > said.gradient.relaxing_share ? line + because(device.handle) : line;
}

}  // namespace bonemill

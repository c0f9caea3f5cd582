#include "render_client/look/hud/device_lines.h"

#include <algorithm>
#include <cmath>

#include "common/device_messages/device_messages.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/figure_text.h"

namespace bonemill {
namespace {

constexpr size_t kLongestDeviceName = 20;

// A state of a later version is an alarm, as its meaning is unknown here.
HudTone toneOf(SafetyState state) {
    switch (state) {
        case SafetyState::kEngaged:
            return HudTone::kPlain;
        case SafetyState::kConnected:
        case SafetyState::kHoming:
        case SafetyState::kReady:
        case SafetyState::kPaused:
            return HudTone::kWarning;
        case SafetyState::kDisconnected:
        case SafetyState::kProtectiveStop:
        case SafetyState::kEmergencyStop:
        case SafetyState::kFault:
            break;
    }
    return HudTone::kAlarm;
}

std::string causeOf(StopCause cause, uint32_t fault_code) {
    const std::string text = tr(nameOf(cause));
    return cause == StopCause::kDeviceFault ? text + " " + std::to_string(fault_code) : text;
}

SafetyState stateOf(const topics::Device& device, const topics::ToolState* tool) {
    return SafetyState(tool ? tool->device_state() : device.state());
}

std::string shownName(const topics::Device& device) {
    const std::string name = shortenedText(device.name(), kLongestDeviceName);
    return name.empty() ? tr("Device") : name;
}

// After a pause a switch that is still held counts as pressed no more.
std::string theDevice(const topics::Device& device) {
    return device.name().empty() ? tr("The device") : tr("The {1}", {device.name()});
}

// {1} is theDevice().
const char* stopText(SafetyState state) {
    switch (state) {
        case SafetyState::kDisconnected:
            return trMark("{1} is not connected");
        case SafetyState::kEmergencyStop:
            return trMark("{1} is in emergency stop");
        case SafetyState::kFault:
            return trMark("{1} is out of order");
        default:
            return trMark("{1} has stopped");
    }
}

// A mouse has neither cable nor motors.
std::string adviceFor(const topics::Device& device, StopCause cause) {
    if (cause == StopCause::kNone) return "";
    if (device.kind() == uint32_t(DeviceKind::kPointer)) return tr(" Reset it, let it go and take it again.");
    return std::string(" ") + tr(whatToDo(cause));
}

const char* whatItWaitsFor(SafetyState state, const topics::Device& device) {
    const bool has_switch = device.abilities() & kAbilityEnablingSwitch;
    if (has_switch && !device.is_enabled()) return tr("hold the enabling switch");
    if (device.force_waits()) return tr("move the tool away from the bone");
    return has_switch && state == SafetyState::kPaused ? tr("let the switch go and press it again") : nullptr;
}

// A device that could not hold the scene's coupling quietly gets a softer one
// (docs/explanation/stability.md).
std::string stiffnessText(const topics::Device& device) {
    constexpr double kAllButAll = 0.995;
    const auto percent = [](double share) {
        return share >= kAllButAll ? std::string("100 %")
                                   : figureText(share * 100, share < 0.1 ? 1 : 0, " %");
    };
    if (!(device.coupling_share() > 0) && !(device.rotation_share() > 0)) return kNoNumber;
    return tr("{1}, turning {2}", {percent(device.coupling_share()), percent(device.rotation_share())});
}

}  // namespace

BurrWork burrWorkOf(const topics::ToolState& tool) {
    if (tool.waits_for_release()) return BurrWork::kIdle;
    // A scene that tells nothing of its effects does not say whether bone goes where nothing touches.
    const bool is_at_bone = !tool.has_effects() || tool.contacts() > 0 || tool.effects().removed_mm3() > 0;
    if (tool.buttons() & kButtonRemove) return is_at_bone ? BurrWork::kRemoving : BurrWork::kTurning;
    return tool.buttons() & kButtonAdd ? BurrWork::kAdding : BurrWork::kIdle;
}

double burrLoadOf(const topics::ToolState& tool) {
    const auto& force = tool.force_n();
    double pressed = force.size() == 3 ? std::hypot(force[0], force[1], force[2]) : 0;
    if (tool.effects().has_burr_force_n()) pressed = tool.effects().burr_force_n();
    return std::isfinite(pressed) ? std::clamp(pressed / kFullLoad, 0.0, 1.0) : 0;
}

std::vector<HudRow> deviceRows(const topics::Device& device, const topics::ToolState* tool) {
    const SafetyState state = stateOf(device, tool);
    return {{shownName(device),
             device.is_simulated() ? tr("{1}, simulated", {tr(nameOf(state))}) : tr(nameOf(state)),
             toneOf(state)},
            {tr("Stiffness"), stiffnessText(device)}};
}

std::optional<HudNotice> deviceStop(const topics::Device& device, const topics::ToolState* tool) {
    const SafetyState state = stateOf(device, tool);
    if (toneOf(state) != HudTone::kAlarm) return std::nullopt;
    const auto cause = StopCause(tool ? tool->stop_cause() : device.stop_cause());
    const std::string why = causeOf(cause, device.fault_code());
    const bool is_mouse = device.kind() == uint32_t(DeviceKind::kPointer);
    std::string text = tr(stopText(state), {theDevice(device)});
    if (cause != StopCause::kNone && why != tr(nameOf(state)) && !is_mouse) text += ": " + why;
    return HudNotice{text + "." + adviceFor(device, cause), HudTone::kAlarm};
}

std::optional<HudNotice> deviceWait(const topics::Device& device, const topics::ToolState* tool) {
    const SafetyState state = stateOf(device, tool);
    if (state != SafetyState::kReady && state != SafetyState::kPaused) return std::nullopt;
    const char* const what = whatItWaitsFor(state, device);
    if (!what) return std::nullopt;
    return HudNotice{tr("{1} is {2}: {3}.", {theDevice(device), tr(nameOf(state)), what}), HudTone::kWarning};
}

}  // namespace bonemill

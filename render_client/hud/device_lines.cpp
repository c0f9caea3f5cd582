#include "render_client/hud/device_lines.h"

#include <cstdio>

#include "common/device_messages/device_messages.h"
#include "render_client/hud/figure_text.h"

namespace bonemill {
namespace {

constexpr size_t kLongestDeviceName = 20;

// A state of a later version is an alarm, for nobody here knows what it means.
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
    const std::string text = nameOf(cause);
    return cause == StopCause::kDeviceFault ? text + " " + std::to_string(fault_code) : text;
}

void addCause(SafetyState state, StopCause cause, uint32_t fault_code, std::vector<HudRow>& rows) {
    if (cause == StopCause::kNone) return;
    const std::string text = causeOf(cause, fault_code);
    if (text != nameOf(state)) rows.push_back({"", text, HudTone::kAlarm});
    for (const std::string& line : wrappedText(whatToDo(cause), kLongestRow))
        rows.push_back({"", line, HudTone::kAlarm});
}

// After a pause a switch that is still held counts as pressed no more.
void addWhatItWaitsFor(SafetyState state, const topics::Device& device, std::vector<HudRow>& rows) {
    const bool has_switch = device.abilities() & kAbilityEnablingSwitch;
    if (has_switch && !device.is_enabled())
        rows.push_back({"", "hold the enabling switch", HudTone::kWarning});
    if (device.force_waits())
        rows.push_back({"", "move the tool away", HudTone::kWarning});
    else if (has_switch && device.is_enabled() && state == SafetyState::kPaused)
        rows.push_back({"", "press the switch anew", HudTone::kWarning});
}

// A device that could not hold the scene's coupling quietly gets a softer one (docs/stability.md).
void addWhatWasGivenUp(const topics::Device& device, std::vector<HudRow>& rows) {
    constexpr double kAllButAll = 0.995;
    const auto add = [&](const char* what, double share) {
        if (!(share > 0 && share < kAllButAll)) return;
        char text[kLongestRow + 1];
        std::snprintf(text, sizeof text, "%s at %.*f %%", what, share < 0.1 ? 1 : 0, share * 100);
        rows.push_back({"", text});
    };
    add("stiffness", device.coupling_share());
    add("turning stiffness", device.rotation_share());
}

}  // namespace

std::vector<HudRow> deviceRows(const topics::Device& device, const topics::ToolState* tool) {
    const auto state = SafetyState(tool ? tool->device_state() : device.state());
    const auto cause = StopCause(tool ? tool->stop_cause() : device.stop_cause());
    const std::string name = shortenedText(device.name(), kLongestDeviceName);
    std::vector<HudRow> rows{{name.empty() ? "Device" : name,
                              std::string(nameOf(state)) + (device.is_simulated() ? ", simulated" : ""),
                              toneOf(state)}};
    if (rows.front().tone == HudTone::kAlarm) addCause(state, cause, device.fault_code(), rows);
    if (state == SafetyState::kReady || state == SafetyState::kPaused) addWhatItWaitsFor(state, device, rows);
    if (state == SafetyState::kEngaged) addWhatWasGivenUp(device, rows);
    return rows;
}

}  // namespace bonemill

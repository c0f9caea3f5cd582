#include "render_client/look/hud/conditions.h"

#include "render_client/look/hud/device_lines.h"
#include "render_client/look/hud/fault_words.h"

namespace bonemill {
namespace {

constexpr char kStaleDevice[] = "stale_device";

void addConnection(Connection connection, std::vector<Condition>& conditions) {
    if (connection == Connection::kServerLost)
        conditions.push_back({"server",
                              "The server is silent: has it crashed, or is the network down? The picture is "
                              "the last that came.",
                              HudTone::kAlarm, true});
    if (connection == Connection::kServerEnded)
        conditions.push_back({"end", "The session has ended. The next one is shown as soon as it begins."});
}

// The server latches its faults; only of the device's silence it says also whether it lasts.
void addTickFaults(const topics::Status& status, std::vector<Condition>& conditions) {
    const bool is_stale = status.device_stale() && status.ticks() > 0;
    if (is_stale)
        conditions.push_back(
            {kStaleDevice, "The device sends nothing: there is no force.", HudTone::kAlarm, true});
    if (status.faults() == 0) return;
    for (const FaultWords& fault : faultWords(status.fault_text()))
        if (!is_stale || fault.name != kStaleDevice)
            conditions.push_back({fault.name, fault.text, fault.tone, true, false});
}

void addDevice(const HudInput& input, std::vector<Condition>& conditions) {
    if (!input.status->has_device()) return;
    const topics::Device& device = input.status->device();
    const topics::ToolState* const tool = input.tool ? &*input.tool : nullptr;
    if (const auto stop = deviceStop(device, tool))
        conditions.push_back({"stop", stop->text, stop->tone, true});
    if (const auto wait = deviceWait(device, tool)) conditions.push_back({"wait", wait->text, wait->tone});
}

// Who presses the pedal wonders.
void addPause(const HudInput& input, std::vector<Condition>& conditions) {
    const bool is_asked = input.tool && input.tool->buttons() != 0;
    if (is_asked && input.status->is_milling_paused())
        conditions.push_back(
            {"paused", "Milling is paused: P goes on, Start begins the next attempt.", HudTone::kWarning});
    else if (is_asked && input.tool->waits_for_release())
        conditions.push_back({"release",
                              "The bone was put back: release the pedal, then the burr cuts again.",
                              HudTone::kWarning});
}

}  // namespace

std::vector<Condition> conditionsOf(const HudInput& input) {
    std::vector<Condition> conditions;
    addConnection(input.connection, conditions);
    if (input.other_server)
        conditions.push_back({"other_server",
                              "Another server gives this session, with the scene '" + *input.other_server +
                                  "'. The picture stays with the first: end one of the two.",
                              HudTone::kWarning});
    const bool is_there = input.connection == Connection::kReceiving || input.connection == Connection::kLive;
    if (!input.status || !is_there) return conditions;  // what a server said last is no news of it
    addDevice(input, conditions);
    addPause(input, conditions);
    addTickFaults(*input.status, conditions);
    return conditions;
}

}  // namespace bonemill

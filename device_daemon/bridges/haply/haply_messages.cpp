#include "device_daemon/bridges/haply/haply_messages.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace bonemill::bridge {
namespace {

using nlohmann::json;

// Members of what may be anything; null where there is nothing.
const json& at(const json& object, const char* name) {
    static const json kNothing;
    const auto found = object.is_object() ? object.find(name) : object.end();
    return object.is_object() && found != object.end() ? *found : kNothing;
}

std::string textAt(const json& object, const char* name) {
    const json& value = at(object, name);
    return value.is_string() ? value.get<std::string>() : "";
}

double numberAt(const json& object, const char* name) {
    const json& value = at(object, name);
    return value.is_number() ? value.get<double>() : std::nan("");
}

void takeBool(const json& object, const char* name, bool& value) {
    if (const json& found = at(object, name); found.is_boolean()) value = found.get<bool>();
}

void takeVector(const json& object, const char* name, std::optional<Eigen::Vector3d>& vector) {
    const json& found = at(object, name);
    if (!found.is_object()) return;
    vector = Eigen::Vector3d(numberAt(found, "x"), numberAt(found, "y"), numberAt(found, "z"));
}

const json* find(const json& devices, const std::string& wanted) {
    if (!devices.is_array()) return nullptr;
    for (const json& device : devices)
        if (const std::string id = textAt(device, "device_id");
            !id.empty() && (wanted.empty() || id == wanted))
            return &device;
    return nullptr;
}

void takeArm(const json& arm, HaplyState& state) {
    state.device_id = textAt(arm, "device_id");
    if (const std::string type = textAt(at(arm, "config"), "type"); !type.empty()) state.type = type;
    takeVector(at(arm, "state"), "cursor_position", state.p_V);
    takeVector(at(arm, "state"), "cursor_velocity", state.v_V);
    const json& status = at(arm, "status");
    takeBool(status, "calibrated", state.is_calibrated);
    takeBool(status, "power_supply", state.has_power);
    takeBool(status, "ready", state.is_ready);
}

void takeGrip(const json& grip, const char* kind, HaplyState& state) {
    state.grip_id = textAt(grip, "device_id");
    state.grip_kind = kind;
    const json& told = at(grip, "state");
    if (const json& q = at(told, "orientation"); q.is_object())
        state.R_V =
            Eigen::Quaterniond(numberAt(q, "w"), numberAt(q, "x"), numberAt(q, "y"), numberAt(q, "z"));
    takeBool(told, "button", state.button_a);
    takeBool(at(told, "buttons"), "a", state.button_a);
    takeBool(at(told, "buttons"), "b", state.button_b);
}

json deviceWith(const std::string& id, json commands) {
    return json::array({json{{"device_id", id}, {"commands", std::move(commands)}}});
}

}  // namespace

bool takeMessage(const std::string& message, const std::string& wanted, HaplyState& state) {
    const json root = json::parse(message, nullptr, false);
    if (!root.is_object()) return false;
    const json& arms = at(root, "inverse3");
    const json* arm = find(arms, state.device_id.empty() ? wanted : state.device_id);
    if (arm) takeArm(*arm, state);
    if (arms.is_array()) state.is_there = arm != nullptr;
    for (const char* kind : {"verse_grip", "wireless_verse_grip"})
        if (const json* grip = find(at(root, kind), state.grip_id);
            grip && (state.grip_id.empty() || state.grip_kind == kind))
            takeGrip(*grip, kind, state);
    return true;
}

std::optional<HaplyDialect> dialectOf(const std::string& service_version) {
    int major = 0, minor = 0;
    if (std::sscanf(service_version.c_str(), "%d.%d", &major, &minor) != 2) return std::nullopt;
    const bool is_new = major > 3 || (major == 3 && minor >= 5);
    return is_new ? HaplyDialect{true, "vector"} : HaplyDialect{false, "values"};
}

std::string probeMessage(const HaplyState& state, const HaplyDialect& dialect, bool is_first) {
    json message{{"inverse3", deviceWith(state.device_id, {{"probe_position", json::object()}})}};
    if (!state.grip_id.empty())
        message[state.grip_kind] = deviceWith(state.grip_id, {{"probe_orientation", json::object()}});
    if (is_first && dialect.has_session)
        message["session"] = {{"configure", {{"profile", {{"name", "bonemill"}}}}}};
    return message.dump();
}

std::string forceMessage(const HaplyState& state, const HaplyDialect& dialect, const Eigen::Vector3d& f_V) {
    const json force{{"x", f_V.x()}, {"y", f_V.y()}, {"z", f_V.z()}};
    return json{
        {"inverse3", deviceWith(state.device_id, {{"set_cursor_force", {{dialect.force_name, force}}}})}}
        .dump();
}

}  // namespace bonemill::bridge

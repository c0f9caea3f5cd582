#include "haptic_server/teaching/study/protocol.h"

#include <algorithm>
#include <set>

#include "common/base/user_error.h"

namespace bonemill::study {
namespace {

constexpr size_t kMaxGroups = 6, kMaxConditions = 12, kMaxTasks = 30, kMaxForms = 20;

// Groups, conditions and tasks: each name once.
template <class Entry>
void requireDifferentIds(const std::vector<Entry>& entries, const JsonObject& json, const std::string& key) {
    std::set<std::string> ids;
    for (const Entry& entry : entries)
        if (!ids.insert(entry.id).second) json.refuse(key, "has the id \"" + entry.id + "\" twice");
}

Order orderOf(const JsonObject& json, const std::string& key, Order otherwise) {
    if (!json.has(key)) return otherwise;
    for (const Order order : {Order::kFixed, Order::kBalanced, Order::kRandom})
        if (json.text(key) == wordOf(order)) return order;
    json.refuse(key, "must be fixed, balanced or random");
}

void readGroups(const JsonObject& json, Protocol& protocol) {
    for (const JsonObject& entry : json.objects("groups", 1, kMaxGroups)) {
        entry.allowOnly({"id", "title", "wanted"});
        protocol.groups.push_back({entry.identifier("id"), entry.textOr("title", entry.identifier("id")),
                                   entry.has("wanted") ? entry.whole("wanted", 0, 100'000) : 0});
    }
    requireDifferentIds(protocol.groups, json, "groups");
}

void readConditions(const JsonObject& json, Protocol& protocol) {
    for (const JsonObject& entry : json.objects("conditions", 0, kMaxConditions)) {
        entry.allowOnly({"id", "title", "options"});
        protocol.conditions.push_back({entry.identifier("id"), entry.textOr("title", entry.identifier("id")),
                                       entry.textOr("options", "")});
    }
    if (protocol.conditions.empty()) protocol.conditions = {{"only", "the only condition", ""}};
    requireDifferentIds(protocol.conditions, json, "conditions");
}

void readTasks(const JsonObject& json, Protocol& protocol) {
    for (const JsonObject& entry : json.objects("tasks", 1, kMaxTasks)) {
        entry.allowOnly({"id", "title", "scene", "seconds", "attempts"});
        protocol.tasks.push_back({entry.identifier("id"), entry.textOr("title", entry.identifier("id")),
                                  entry.textOr("scene", ""), entry.numberOr("seconds", 0, 0, 1e6),
                                  entry.has("attempts") ? entry.whole("attempts", 1, 100) : 1});
    }
    requireDifferentIds(protocol.tasks, json, "tasks");
}

}  // namespace

const Group* Protocol::findGroup(const std::string& group_id) const {
    for (const Group& group : groups)
        if (group.id == group_id) return &group;
    return nullptr;
}

std::vector<std::string> Protocol::formIds() const {
    std::vector<std::string> ids;
    for (const auto* forms : {&forms_before, &forms_after_each, &forms_after})
        for (const std::string& id : *forms)
            if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
    return ids;
}

Protocol parseProtocol(const std::string& text, const std::string& file) {
    const Json parsed = parseJson(text, file);
    const JsonObject json(parsed, file);
    json.allowOnly({"study",
                    "title",
                    "seed",
                    "alpha",
                    "power",
                    "threshold",
                    "groups",
                    "conditions",
                    "tasks",
                    "condition_order",
                    "task_order",
                    "forms_before",
                    "forms_after_each",
                    "forms_after",
                    "hypothesis",
                    "orientation",
                    "feedback",
                    "blinding",
                    "sample_size_reason",
                    "ethics",
                    "device"});
    Protocol protocol;
    protocol.id = json.identifier("study");
    protocol.title = json.text("title");
    protocol.seed = json.whole("seed", 0, size_t(1) << 53);
    protocol.alpha = json.numberOr("alpha", protocol.alpha, 1e-4, 0.5);
    protocol.power = json.numberOr("power", protocol.power, 0.5, 0.999);
    protocol.threshold = json.numberOr("threshold", protocol.threshold, -1e9, 1e9);
    readGroups(json, protocol);
    readConditions(json, protocol);
    readTasks(json, protocol);
    protocol.condition_order = orderOf(json, "condition_order", protocol.condition_order);
    protocol.task_order = orderOf(json, "task_order", protocol.task_order);
    protocol.forms_before = json.identifiers("forms_before", kMaxForms);
    protocol.forms_after_each = json.identifiers("forms_after_each", kMaxForms);
    protocol.forms_after = json.identifiers("forms_after", kMaxForms);
    for (const std::string& id : protocol.forms_before)
        if (std::count(protocol.forms_after.begin(), protocol.forms_after.end(), id))
            json.refuse("forms_after", "has \"" + id + "\", which stands in \"forms_before\", too");
    const std::pair<const char*, std::string Protocol::*> told[] = {
        {"hypothesis", &Protocol::hypothesis}, {"orientation", &Protocol::orientation},
        {"feedback", &Protocol::feedback},     {"blinding", &Protocol::blinding},
        {"ethics", &Protocol::ethics},         {"sample_size_reason", &Protocol::sample_size_reason},
        {"device", &Protocol::device}};
    for (const auto& [key, field] : told) protocol.*field = json.textOr(key, "");
    return protocol;
}

const char* wordOf(Order order) {
    return order == Order::kFixed ? "fixed" : order == Order::kBalanced ? "balanced" : "random";
}

std::string exampleProtocol() {
    return R"({
  "study": "face_validity",
  "title": "Face validity, with and without torque",
  "seed": 2011,
  "alpha": 0.05,
  "power": 0.8,
  "threshold": 3,
  "groups": [
    {"id": "orthopedist", "title": "Orthopedists", "wanted": 13},
    {"id": "resident", "title": "Residents", "wanted": 8}
  ],
  "conditions": [
    {"id": "torque", "title": "Force and torque", "options": ""},
    {"id": "force_only", "title": "Force only", "options": ""}
  ],
  "condition_order": "balanced",
  "tasks": [
    {"id": "exploring", "title": "Explore the tooth without milling", "scene": "deploy/scenes/tooth_wall.textproto", "seconds": 120},
    {"id": "corridor", "title": "Two corridors that meet", "scene": "deploy/scenes/tooth_corridor.textproto", "seconds": 300, "attempts": 1}
  ],
  "task_order": "fixed",
  "forms_before": [],
  "forms_after_each": ["nasa_tlx_raw"],
  "forms_after": ["thesis_5_4", "sus"],
  "hypothesis": "",
  "orientation": "",
  "feedback": "",
  "blinding": "",
  "sample_size_reason": "",
  "ethics": "",
  "device": ""
}
)";
}

}  // namespace bonemill::study

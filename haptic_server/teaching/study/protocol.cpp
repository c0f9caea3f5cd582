#include "haptic_server/teaching/study/protocol.h"

#include <algorithm>
#include <numeric>
#include <random>
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

Sequence counted(size_t count) {
    Sequence sequence(count);
    std::iota(sequence.begin(), sequence.end(), size_t(0));
    return sequence;
}

// std::shuffle differs between libraries.
Sequence shuffled(size_t count, std::mt19937_64& random) {
    Sequence sequence = counted(count);
    for (size_t i = count; i > 1; --i) std::swap(sequence[i - 1], sequence[random() % i]);
    return sequence;
}

std::mt19937_64 randomOf(uint64_t seed, const std::string& group, const std::string& purpose, size_t block) {
    std::vector<uint32_t> words = {uint32_t(seed), uint32_t(seed >> 32), uint32_t(block)};
    for (const std::string& text : {group, purpose}) {
        words.push_back(uint32_t(text.size()));
        for (const char c : text) words.push_back(uint8_t(c));
    }
    std::seed_seq sequence(words.begin(), words.end());
    return std::mt19937_64(sequence);
}

}  // namespace

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

std::vector<Sequence> williamsSquare(size_t count) {
    std::vector<Sequence> rows;
    // The first row goes 0, 1, n-1, 2, n-2 ...; the others are shifted by one each.
    for (size_t shift = 0; shift < count; ++shift) {
        Sequence row;
        for (size_t i = 0; i < count; ++i)
            row.push_back(((i % 2 ? (i + 1) / 2 : count - i / 2) + shift) % count);
        rows.push_back(row);
    }
    if (count % 2 && count > 1)
        for (size_t i = 0; i < count; ++i) rows.emplace_back(rows[i].rbegin(), rows[i].rend());
    return rows;
}

Sequence sequenceOf(Order order, size_t count, uint64_t seed, const std::string& group,
                    const std::string& purpose, size_t place) {
    if (order == Order::kFixed || count < 2) return counted(count);
    if (order == Order::kRandom) {
        std::mt19937_64 random = randomOf(seed, group, purpose, place);
        return shuffled(count, random);
    }
    const std::vector<Sequence> rows = williamsSquare(count);
    std::mt19937_64 random = randomOf(seed, group, purpose, place / rows.size());
    return rows[shuffled(rows.size(), random)[place % rows.size()]];
}

std::vector<PlannedSession> plannedSessions(const Protocol& protocol, const std::string& group,
                                            size_t place) {
    const auto sequence = [&](Order order, size_t count, const char* purpose) {
        return sequenceOf(order, count, protocol.seed, group, purpose, place);
    };
    const Sequence conditions = sequence(protocol.condition_order, protocol.conditions.size(), "conditions");
    const Sequence tasks = sequence(protocol.task_order, protocol.tasks.size(), "tasks");
    std::vector<PlannedSession> sessions;
    for (const size_t condition : conditions)
        for (const size_t task : tasks)
            for (size_t attempt = 1; attempt <= protocol.tasks[task].attempts; ++attempt)
                sessions.push_back({protocol.conditions[condition].id, protocol.tasks[task].id, attempt});
    return sessions;
}

}  // namespace bonemill::study

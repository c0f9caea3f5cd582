#include "haptic_server/teaching/attempt_report/xapi.h"

#include <cinttypes>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace bonemill {
namespace {

// Names that are nobody's on the network (RFC 2606): identifiers, not addresses.
constexpr const char* kRoot = "https://bonemill.invalid/";

uint64_t fnv1a(const std::string& text, uint64_t hash) {
    for (const char c : text) hash = (hash ^ uint8_t(c)) * 0x100000001b3;
    return hash;
}

// In the form of a name-based UUID (version 5); the hash is our own.
std::string idOf(const AttemptResult& result) {
    const std::string name =
        result.pseudonym + '\n' + result.scene_hash + '\n' + std::to_string(result.start_unix_ns);
    const uint64_t high = fnv1a(name, 0xcbf29ce484222325), low = fnv1a(name, high);
    char text[40];
    std::snprintf(text, sizeof text, "%08" PRIx64 "-%04" PRIx64 "-5%03" PRIx64 "-%04" PRIx64 "-%012" PRIx64,
                  high >> 32, high >> 16 & 0xffff, high & 0xfff, (low >> 48 & 0x3fff) | 0x8000,
                  low & 0xffffffffffff);
    return text;
}

std::string durationText(double seconds) {
    char text[48];
    std::snprintf(text, sizeof text, "PT%.2fS", seconds);
    return text;
}

}  // namespace

std::string xapiStatement(const AttemptResult& result) {
    using Json = nlohmann::ordered_json;
    const Assessment& assessment = result.assessment;
    const bool has_gates = !assessment.gates.empty();
    const std::string verb = !has_gates ? "completed" : assessment.hasPassed() ? "passed" : "failed";
    const std::string root = kRoot;
    Json outcome = {{"completion", true}, {"duration", durationText(result.duration_s)}};
    if (has_gates) outcome["success"] = assessment.hasPassed();
    if (assessment.total) outcome["score"] = {{"scaled", assessment.total->score}};
    Json figures = Json::object();
    for (const Figure& figure : assessment.figures)
        figures[figure.id + "@" + std::to_string(figure.version)] = {{"value", figure.value},
                                                                     {"unit", figure.unit}};
    outcome["extensions"] = {{root + "figures", figures}};
    const Json statement = {
        {"id", idOf(result)},
        {"actor",
         {{"objectType", "Agent"},
          {"account", {{"homePage", root + "pseudonyms"}, {"name", result.pseudonym}}}}},
        {"verb", {{"id", "http://adlnet.gov/expapi/verbs/" + verb}, {"display", {{"en", verb}}}}},
        {"object",
         {{"objectType", "Activity"},
          {"id", root + "scenes/" + result.scene_hash},
          {"definition",
           {{"name", {{"en", result.scene_title}}},
            {"type", "http://adlnet.gov/expapi/activities/simulation"}}}}},
        {"result", outcome},
        {"timestamp", utcText(result)}};
    return statement.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace bonemill

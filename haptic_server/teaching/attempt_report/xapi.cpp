#include "haptic_server/teaching/attempt_report/xapi.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/digest/digest.h"

namespace bonemill {
namespace {

// Names that are nobody's on the network (RFC 2606): identifiers, not addresses.
constexpr const char* kRoot = "https://bonemill.invalid/";

std::string idOf(const AttemptResult& result) {
    return uuidOfName(kUrlNames, std::string(kRoot) + "attempts/" + result.pseudonym + '\n' +
                                     result.scene_hash + '\n' + std::to_string(result.start_unix_ns));
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

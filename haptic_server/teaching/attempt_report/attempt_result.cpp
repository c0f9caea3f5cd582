#include "haptic_server/teaching/attempt_report/attempt_result.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/user_error.h"
#include "common/digest/digest.h"

namespace bonemill {
namespace {

using Json = nlohmann::ordered_json;
// Objects of the other kind take a time that is quadratic in their keys, which a stranger may have written.
using ReadJson = nlohmann::json;

constexpr int kFormat = 1;
constexpr size_t kMostEntries = 20'000;  // of any list

Json figureJson(const Figure& figure) {
    return {{"id", figure.id},
            {"version", figure.version},
            {"label", figure.label},
            {"value", figure.value},
            {"unit", figure.unit}};
}

Json seriesJson(const Series& series) {
    return {{"id", series.id}, {"label", series.label}, {"unit", series.unit}, {"values", series.values}};
}

template <class Items, class JsonOf>
Json listOf(const Items& items, JsonOf json_of) {
    Json list = Json::array();
    for (const auto& item : items) list.push_back(json_of(item));
    return list;
}

Json gateJson(const GateResult& gate) {
    return {{"id", gate.id},       {"label", gate.label},     {"figure", gate.figure_id},
            {"limit", gate.limit}, {"is_most", gate.is_most}, {"is_passed", gate.is_passed},
            {"text", gate.text}};
}

Json subScoreJson(const SubScore& sub) {
    return {{"id", sub.id},        {"label", sub.label}, {"figure", figureJson(sub.figure)},
            {"worst", sub.worst},  {"best", sub.best},   {"score", sub.score},
            {"weight", sub.weight}};
}

Json momentJson(const Moment& moment) {
    return {{"t_s", moment.t_s}, {"kind", moment.kind}, {"text", moment.text}, {"severity", moment.severity}};
}

Json tableJson(const SeriesTable& table) {
    return {
        {"id", table.id}, {"index", seriesJson(table.index)}, {"columns", listOf(table.columns, seriesJson)}};
}

double numberOf(const ReadJson& json, const char* key) {
    const double value = json.at(key).get<double>();
    if (!std::isfinite(value)) throw std::range_error(std::string(key) + " is not finite");
    return value;
}

const ReadJson& boundedList(const ReadJson& json, const char* key) {
    const ReadJson& list = json.at(key);
    if (!list.is_array() || list.size() > kMostEntries)
        throw std::length_error(std::string(key) + " is no list, or too long");
    return list;
}

Figure readFigure(const ReadJson& json) {
    return {json.at("id").get<std::string>(), json.at("version").get<int>(),
            json.at("label").get<std::string>(), numberOf(json, "value"), json.at("unit").get<std::string>()};
}

// JSON has no NaN: null stands for it.
Series readSeries(const ReadJson& json) {
    Series series{json.at("id").get<std::string>(),
                  json.at("label").get<std::string>(),
                  json.at("unit").get<std::string>(),
                  {}};
    for (const ReadJson& value : boundedList(json, "values"))
        series.values.push_back(value.is_null() ? std::numeric_limits<double>::quiet_NaN()
                                                : value.get<double>());
    return series;
}

GateResult readGate(const ReadJson& json) {
    return {json.at("id").get<std::string>(),     json.at("label").get<std::string>(),
            json.at("figure").get<std::string>(), numberOf(json, "limit"),
            json.at("is_most").get<bool>(),       json.at("is_passed").get<bool>(),
            json.at("text").get<std::string>()};
}

SubScore readSubScore(const ReadJson& json) {
    return {json.at("id").get<std::string>(), json.at("label").get<std::string>(),
            readFigure(json.at("figure")),    numberOf(json, "worst"),
            numberOf(json, "best"),           numberOf(json, "score"),
            numberOf(json, "weight")};
}

Moment readMoment(const ReadJson& json) {
    return {numberOf(json, "t_s"), json.at("kind").get<std::string>(), json.at("text").get<std::string>(),
            numberOf(json, "severity")};
}

SeriesTable readTable(const ReadJson& json) {
    SeriesTable table{json.at("id").get<std::string>(), readSeries(json.at("index")), {}};
    for (const ReadJson& column : boundedList(json, "columns")) {
        table.columns.push_back(readSeries(column));
        if (table.columns.back().values.size() != table.index.values.size())
            throw std::length_error("columns of different length");
    }
    return table;
}

Assessment readAssessment(const ReadJson& json) {
    Assessment assessment;
    for (const ReadJson& gate : boundedList(json, "gates")) assessment.gates.push_back(readGate(gate));
    for (const ReadJson& figure : boundedList(json, "figures"))
        assessment.figures.push_back(readFigure(figure));
    for (const ReadJson& sub : boundedList(json, "sub_scores"))
        assessment.sub_scores.push_back(readSubScore(sub));
    if (json.contains("total"))
        assessment.total = Total{numberOf(json.at("total"), "score"), json.at("total").value("done", 1.0),
                                 json.at("total").at("weights_version").get<int>(),
                                 json.at("total").at("weights_hash").get<std::string>()};
    for (const ReadJson& table : boundedList(json, "series")) assessment.series.push_back(readTable(table));
    for (const ReadJson& moment : boundedList(json, "moments"))
        assessment.moments.push_back(readMoment(moment));
    return assessment;
}

AttemptResult readResult(const ReadJson& json) {
    if (json.at("bonemill_result").get<int>() != kFormat) throw std::range_error("another format");
    AttemptResult result;
    result.pseudonym = json.at("pseudonym").get<std::string>();
    result.number = json.at("attempt").get<uint32_t>();
    result.scene_id = json.at("scene").at("id").get<std::string>();
    result.scene_title = json.at("scene").at("title").get<std::string>();
    result.scene_hash = json.at("scene").at("hash").get<std::string>();
    result.start_unix_ns = json.at("start_unix_ns").get<int64_t>();
    result.duration_s = numberOf(json, "duration_s");
    result.journal = json.at("journal").get<std::string>();
    result.chain = json.value("chain", "");  // earlier releases had none
    result.is_exam = json.at("exam").get<bool>();
    result.assessment = readAssessment(json);
    return result;
}

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

std::string resultJson(const AttemptResult& result) {
    const Assessment& assessment = result.assessment;
    Json json = {
        {"bonemill_result", kFormat},
        {"pseudonym", result.pseudonym},
        {"attempt", result.number},
        {"scene", {{"id", result.scene_id}, {"title", result.scene_title}, {"hash", result.scene_hash}}},
        {"start_utc", utcText(result)},
        {"start_unix_ns", result.start_unix_ns},
        {"duration_s", result.duration_s},
        {"journal", result.journal},
        {"chain", result.chain},
        {"exam", result.is_exam},
        {"gates", listOf(assessment.gates, gateJson)},
        {"sub_scores", listOf(assessment.sub_scores, subScoreJson)}};
    if (!assessment.gates.empty()) json["passed"] = assessment.hasPassed();
    if (const std::optional<Total>& total = assessment.total)
        json["total"] = {{"score", total->score},
                         {"done", total->done},
                         {"weights_version", total->weights_version},
                         {"weights_hash", total->weights_hash}};
    json["figures"] = listOf(assessment.figures, figureJson);
    json["moments"] = listOf(assessment.moments, momentJson);
    json["series"] = listOf(assessment.series, tableJson);
    return json.dump(1, '\t', false, Json::error_handler_t::replace) + "\n";
}

AttemptResult parseResult(const std::string& text, const std::string& file) {
    try {
        if (text.size() > kMaxResult) throw std::length_error("too large");
        return readResult(ReadJson::parse(text));
    } catch (const std::exception& error) {
        throw UserError(file + ": is no result of an attempt (" + error.what() + ")");
    }
}

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

#include "haptic_server/teaching/study/run_record.h"

#include "common/base/user_error.h"

namespace bonemill::study {
namespace {

constexpr double kMaxFigure = 1e15;

std::map<std::string, double> figuresIn(const JsonObject& json) {
    std::map<std::string, double> figures;
    for (const char* const key : kRunFigures)
        if (json.has(key)) figures[key] = json.number(key, -kMaxFigure, kMaxFigure);
    return figures;
}

}  // namespace

std::map<std::string, double> figuresOfReport(const std::filesystem::path& report) {
    const Json json = readJson(report);
    const std::map<std::string, double> figures = figuresIn(JsonObject(json, report.string()));
    if (figures.empty())
        throw UserError(report.string() + ": is no report that haptic_server wrote with --report");
    return figures;
}

std::string toJson(const RunRecord& run) {
    const Json json = {{"session", run.session},           {"scene", run.scene},
                       {"scene_sha256", run.scene_sha256}, {"programs", run.programs},
                       {"figures", run.figures},           {"recording", run.recording}};
    return json.dump(1) + "\n";
}

RunRecord parseRun(const Json& parsed, const std::string& file) {
    const JsonObject json(parsed, file);
    json.allowOnly({"session", "scene", "scene_sha256", "programs", "figures", "recording"});
    return {json.text("session"),
            json.text("scene"),
            json.text("scene_sha256"),
            json.text("programs"),
            figuresIn(json.object("figures")),
            json.text("recording")};
}

}  // namespace bonemill::study

#include "haptic_server/lab/what_if/what_if.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_tools.h"
#include "haptic_server/core/tick/tick_choices.h"
#include "haptic_server/lab/assess/judge_attempts.h"
#include "haptic_server/lab/what_if/otherwise_run.h"
#include "haptic_server/lab/what_if/what_if_page.h"
#include "haptic_server/scene/setup/scene_accuracy.h"
#include "haptic_server/teaching/attempt_report/report_words.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

// The attempt in which the tick lies, or the whole session.
RecordedAttempt attemptAt(const Recording& recording, uint64_t tick) {
    for (const RecordedAttempt& attempt : recordedAttempts(recording.content()))
        if (attempt.begin <= tick && tick < attempt.end) return attempt;
    return {};
}

uint64_t tickOf(const WhatIfOptions& options, const Recording& recording) {
    if (options.at_s >= recording.lengthS())
        throw UserError(options.journal.string() + ": ends after " + roundedText(recording.lengthS()) +
                        " s: --at takes an earlier moment");
    return recording.tickAt(options.at_s);
}

uint32_t accuracyNamed(const std::string& name, const scene::Scene& scene) {
    const std::optional<Preset> preset = presetOfName(name);
    if (!preset) throw UserError("--accuracy " + name + ": there are " + presetNames());
    if (const std::string why_not = PresetRule(scene).whyNot(*preset); !why_not.empty())
        throw UserError("--accuracy " + name + ": " + why_not);
    return uint32_t(AccuracySwitch::choiceOf(*preset));
}

void add(std::string& change, const std::string& words) {
    change += (change.empty() ? "" : ", ") + words;
}

// What is asked for, and `change`: the same for people.
Otherwise otherwiseOf(const WhatIfOptions& options, const LoadedScene& loaded, std::string& change) {
    Otherwise otherwise;
    if (!options.tool.empty()) {
        const std::vector<std::string> names = toolNamesOf(loaded.scene);
        otherwise.tool = uint32_t(toolIndexOf(names, options.tool));
        add(change, "with the tool " + names[*otherwise.tool]);
    }
    if (!options.accuracy.empty()) {
        otherwise.accuracy = accuracyNamed(options.accuracy, loaded.scene);
        add(change, "computed as " + options.accuracy);
    }
    if (!options.shift_mm.empty()) {
        otherwise.shift_W = kMillimetre * Eigen::Vector3d(options.shift_mm.data());
        std::string words = "the hand shifted by (";
        for (const double part : options.shift_mm)
            words += (words.back() == '(' ? "" : ", ") + roundedText(part);
        add(change, words + ") mm");
    }
    if (options.pace != 1) add(change, "the hand " + roundedText(options.pace) + " times as fast");
    otherwise.pace = options.pace;
    if (!options.is_experts) return otherwise;
    const std::shared_ptr<const JudgedTask> task = setUpScene(loaded).task;
    if (!task || !task->expert)
        throw UserError(
            "--expert: the recorded scene has no assessment.expert_path (docs/reference/tasks.md)");
    if (options.pace != 1) throw UserError("--pace and --expert: whose hand? take one of them");
    otherwise.expert = task->expert;
    add(change, "the expert's hand");
    return otherwise;
}

Course courseOf(const Recording& recording, const RecordedAttempt& attempt) {
    Course course;
    const std::vector<RecordedAttempt> attempts{attempt};
    AttemptsJudge(recording, attempts).run([&](const AttemptOutcome& judged) {
        course = {judged.result.assessment, judged.begin_s, judged.duration_s};
    });
    return course;
}

std::string proofOf(uint64_t same, uint64_t first) {
    if (same == first)
        return "Until then both are the same, bit by bit, in all " + std::to_string(first) + " ticks.";
    return "Tick " + std::to_string(same) + " of " + std::to_string(first) +
           " before that moment is not the session's bits: it was recorded by another build, or on another "
           "processor.";
}

nlohmann::json jsonOf(const Course& course) {
    nlohmann::json json = assessmentJson(course.assessment);
    json["duration_s"] = course.duration_s;
    return json;
}

std::string replayOf(const WhatIfOptions& options) {
    char at[32];
    std::snprintf(at, sizeof at, "%.1f", std::max(0.0, options.at_s - 3));
    return "bonemill replay " + fs::absolute(options.journal).string() + " --at " + at + " --against " +
           fs::absolute(options.out).string();
}

fs::path beside(const fs::path& recording, const char* ending) {
    return fs::path(recording).replace_extension(ending);
}

void requireNew(const fs::path& out) {
    if (out.extension() != ".mcap")
        throw UserError("--out " + out.string() + ": give a name that ends in .mcap");
    for (const fs::path& file : {out, beside(out, ".html"), beside(out, ".json")})
        if (fs::exists(fs::symlink_status(file)))
            throw UserError("--out " + out.string() + ": " + file.filename().string() +
                            " is there already; give another name");
}

}  // namespace

void whatIf(const WhatIfOptions& options, std::ostream& said) {
    const Recording happened(options.journal);
    const LoadedScene loaded = happened.scene();
    OtherwiseRun run;
    run.otherwise = otherwiseOf(options, loaded, run.change);
    if (run.change.empty())
        throw UserError(
            "say what is otherwise: --tool, --accuracy, --shift-mm, --pace or --expert (see --help)");
    run.first = tickOf(options, happened);
    run.attempt = attemptAt(happened, run.first);
    run.version = options.version;
    requireNew(options.out);
    const RecordedAttempt attempt = recordOtherwise(happened, run, options.out);
    const Recording otherwise(options.out);
    const Course was = courseOf(happened, run.attempt), would_be = courseOf(otherwise, attempt);
    const WhatIfWords words{titleOf(loaded.scene),
                            run.attempt.trainee,
                            run.change,
                            options.at_s,
                            proofOf(sameTicks(happened, otherwise, run.first), run.first),
                            replayOf(options)};
    const fs::path page = beside(options.out, ".html");
    writeBytes(page.string(), whatIfPage(was, would_be, words));
    const nlohmann::json json{{"recording", options.journal.string()},
                              {"at_s", options.at_s},
                              {"change", run.change},
                              {"proof", words.proof},
                              {"happened", jsonOf(was)},
                              {"otherwise", jsonOf(would_be)}};
    writeBytes(beside(options.out, ".json").string(),
               json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
    said << "What if, from " << roundedText(options.at_s) << " s on: " << run.change << '\n'
         << whatIfText(was, would_be) << words.proof << '\n'
         << "report: " << fs::absolute(page).string() << '\n'
         << "side by side: " << words.replay << '\n';
}

}  // namespace bonemill

#include "haptic_server/teaching/study_report/report.h"

#include <algorithm>
#include <set>

#include "common/files/whole_file.h"
#include "common/text/csv_text.h"
#include "haptic_server/teaching/study/shipped_files.h"
#include "haptic_server/teaching/study_report/number_text.h"
#include "haptic_server/teaching/study_report/study_report_text.h"
#include "haptic_server/teaching/study_report/study_tables.h"

namespace bonemill::study {
namespace {

std::string line(const std::string& item, const std::string& what) {
    return "| " + item + " | " + (what.empty() ? "**to be written by you**" : what) + " |\n";
}

// What the protocol tells in its own words, or which field waits for it.
std::string told(const std::string& words, const std::string& field) {
    return words.empty() ? "**not told: fill in \"" + field + "\" of protocol.json**" : cellText(words);
}

std::string joined(const std::set<std::string>& texts) {
    std::string all;
    for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
    return all;
}

std::string programsOf(const StudyData& data, const std::string& program_version) {
    std::set<std::string> versions;
    for (const auto& [session, run] : data.runs) versions.insert(run.programs);
    return versions.empty() ? "no run was attached (study attach); this report was made by " + program_version
                            : joined(versions) + "; report by " + program_version;
}

std::string scenesOf(const StudyData& data) {
    std::set<std::string> scenes;
    for (const auto& [session, run] : data.runs)
        if (!run.scene.empty())
            scenes.insert(cellText(run.scene) + " (SHA-256 " + run.scene_sha256.substr(0, 16) + "…)");
    if (!scenes.empty()) return joined(scenes);
    for (const Task& task : data.protocol().tasks)
        if (!task.scene.empty()) scenes.insert(cellText(task.scene) + " (planned)");
    return joined(scenes);
}

std::string rangeOf(const StudyData& data, const std::string& figure, const std::string& unit, int digits) {
    std::vector<double> values;
    for (const auto& [session, run] : data.runs)
        if (run.figures.contains(figure)) values.push_back(run.figures.at(figure));
    if (values.empty()) return "not attached (study attach SESSION --report FILE)";
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return fixedText(*least, digits) + " to " + fixedText(*most, digits) + " " + unit + " over " +
           std::to_string(values.size()) + " runs";
}

std::string attemptsOf(const Protocol& protocol) {
    std::set<std::string> attempts;
    for (const Task& task : protocol.tasks)
        attempts.insert(cellText(task.id) + ": " + std::to_string(task.attempts) +
                        (task.seconds > 0 ? " of at most " + numberText(task.seconds) + " s" : ""));
    return joined(attempts);
}

std::string ordersOf(const Protocol& protocol) {
    return std::string("conditions ") + wordOf(protocol.condition_order) + ", tasks " +
           wordOf(protocol.task_order) +
           "; balanced orders are the rows of a Williams square, in random permuted blocks within each "
           "group, seed " +
           std::to_string(protocol.seed);
}

// The orders that people had, and how many had each.
std::string sequencesOf(const StudyData& data) {
    std::map<std::string, size_t> counts;
    for (const Participant& person : data.people) {
        std::string sequence, last;
        for (const Session& session : person.sessions) {
            if (session.period == 0 || session.condition == last) continue;
            sequence += (sequence.empty() ? "" : " → ") + cellText(session.condition);
            last = session.condition;
        }
        ++counts[person.group + ": " + sequence];
    }
    std::set<std::string> texts;
    for (const auto& [sequence, count] : counts) texts.insert(sequence + " (" + std::to_string(count) + ")");
    return joined(texts);
}

std::string formsOf(const StudyData& data) {
    std::set<std::string> forms;
    for (const std::string& id : data.protocol().formIds()) {
        const Form& form = data.folder->form(id);
        forms.insert(cellText(form.title) + " (`" + id + "`, version " + std::to_string(form.version) + ", " +
                     form.language + ", SHA-256 " + form.digest.substr(0, 16) + "…)");
    }
    return joined(forms);
}

}  // namespace

std::string checklistText(const StudyData& data, const std::string& program_version) {
    const Protocol& protocol = data.protocol();
    const auto consents = std::count_if(data.people.begin(), data.people.end(),
                                        [](const Participant& person) { return person.has_consent; });
    std::string text =
        "# Reporting checklist: " + cellText(protocol.title) +
        "\n\nAfter CONSORT and STROBE with the extensions for simulation-based research (Cheng et al. 2016, "
        "doi 10.1186/s41077-016-0025-y), and what reviewers of haptics ask for. The study tool fills in what "
        "it "
        "knows.\n\n| item | |\n| --- | --- |\n";
    text += line("title and abstract name simulation as subject or means", "");
    text += line("background, and why a simulator answers the question", "");
    text += line("hypothesis, primary outcome", told(protocol.hypothesis, "hypothesis"));
    text +=
        line("ethics, consent", told(protocol.ethics, "ethics") + "; consent noted for " +
                                    std::to_string(consents) + " of " + std::to_string(data.people.size()));
    text += line("participants: groups, eligibility, prior simulator experience",
                 "groups in report.md; demographics in answers.csv; eligibility: **to be written by you**");
    text += line("simulator, versions", programsOf(data, program_version));
    text += line("device: type, stiffness, force limits", told(protocol.device, "device"));
    text += line("scenarios (scene files)", scenesOf(data));
    text += line("haptic rate: nominal", rangeOf(data, "nominal_rate_hz", "Hz", 0));
    text += line("haptic rate: mean", rangeOf(data, "mean_rate_hz", "Hz", 1));
    text += line("haptic rate: slowest second", rangeOf(data, "slowest_second_hz", "Hz", 0));
    text += line("dropped ticks", rangeOf(data, "dropped_ticks", "", 0));
    text += line("largest force on the hand", rangeOf(data, "force_max_n", "N", 2));
    text += line("orientation to the simulator", told(protocol.orientation, "orientation"));
    text += line("attempts and time per task", attemptsOf(protocol));
    text += line("feedback and debriefing", told(protocol.feedback, "feedback"));
    text += line("outcome instruments", formsOf(data) + "; Cronbach's alpha in report.md");
    text += line("sample size and its reason", told(protocol.sample_size_reason, "sample_size_reason") +
                                                   "; what it can see is in report.md");
    text += line("order, randomisation, who knew it before",
                 ordersOf(protocol) + "; drawn by the program when a participant was enrolled");
    text += line("orders that people had", sequencesOf(data));
    text += line("blinding", told(protocol.blinding, "blinding"));
    text += line("statistical methods, and how many tests", "report.md, last section; Holm within each form");
    text += line("flow of participants, drop-outs", "report.md, first table");
    text += line("raw data", "answers.csv and sessions.csv beside this file; recordings as named there");
    text += line("limits of the study, and of the simulator", "");
    text += line("funding, interests, registration", "");
    return text;
}

void writeReport(const StudyFolder& folder, const std::filesystem::path& out,
                 const std::string& program_version) {
    const StudyData data = readStudy(folder);
    const std::vector<Measure> measures = measuresOf(data);
    const std::vector<GroupComparison> groups = compareGroups(data, measures);
    const std::vector<ConditionComparison> conditions = compareConditions(data, measures);
    for (const TableFile& table : tablesOf(data, measures, groups, conditions))
        writePrivateFile(out / table.name, table.text);
    writePrivateFile(out / "report.md", reportText(data, measures, groups, conditions));
    writePrivateFile(out / "checklist.md", checklistText(data, program_version));
    writePrivateFile(out / "analysis.R", shippedAnalysis());
}

}  // namespace bonemill::study

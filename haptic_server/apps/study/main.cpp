// study plans, asks, keeps and judges a user study on the simulator (docs/howto/study.md).
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/cli/version.h"
#include "common/digest/digest.h"
#include "common/files/whole_file.h"
#include "common/process/run_program.h"
#include "haptic_server/teaching/study/ask_form.h"
#include "haptic_server/teaching/study/study_folder.h"
#include "haptic_server/teaching/study_report/agreement.h"
#include "haptic_server/teaching/study_report/plan_text.h"
#include "haptic_server/teaching/study_report/report.h"

namespace bonemill::study {
namespace {

struct Options {
    std::string folder, group, pseudonym, session, form, reason, out, report, scene, recording;
    std::vector<std::string> files;
    bool has_consent = false, replaces = false;
    std::vector<size_t> groups;
    Plan plan;
    double printed_p = 0;  // 0: none was given
};

std::string titleOf(const Session& session) {
    if (session.period == 0) return "visit";
    return std::to_string(session.period) + ". " + session.condition + ", " + session.task +
           (session.attempt > 1 ? ", attempt " + std::to_string(session.attempt) : "");
}

const Task* taskOf(const Protocol& protocol, const std::string& id) {
    for (const Task& task : protocol.tasks)
        if (task.id == id) return &task;
    return nullptr;
}

std::string programVersion() {
    return "bonemill " + versionText();
}

// One line per form of a session, with what has become of it.
std::string formLines(const StudyFolder& folder, const Participant& person, const Session& session) {
    std::string text;
    for (const std::string& id : folder.formsOf(session)) {
        const Answers answers = folder.answers(person, session.uuid, id);
        const size_t given = answers.values.size() + answers.left_out.size();
        const size_t all = folder.form(id).items().size();
        const bool is_before =
            std::count(folder.protocol().forms_before.begin(), folder.protocol().forms_before.end(), id) > 0;
        const std::string when = session.period > 0 ? "" : is_before ? " (before all)" : " (after all)";
        text += "     ";
        text += id;
        text += when;
        text += ": " + std::to_string(given) + " of " + std::to_string(all) + " questions\n";
    }
    return text;
}

// Finds the session, and refuses a form that the protocol does not ask for in it.
Answers askedIn(const StudyFolder& folder, const std::string& session, const std::string& form) {
    const Participant person = folder.participantOf(session);
    const std::vector<std::string> asked = folder.formsOf(*person.find(session));
    if (std::find(asked.begin(), asked.end(), form) == asked.end()) {
        std::string names;
        for (const std::string& id : asked) names += " " + id;
        throw UserError("the protocol does not ask for \"" + form + "\" in this session, but for:" + names);
    }
    return folder.answers(person, session, form);
}

int init(const Options& options) {
    makeStudy(options.folder);
    std::cout << options.folder << "/protocol.json is an example: edit it, then type: study check "
              << options.folder << "\n";
    return 0;
}

int check(const Options& options) {
    const StudyFolder folder(options.folder);
    const Protocol& protocol = folder.protocol();
    std::cout << protocol.title << ": " << protocol.groups.size() << " groups, " << protocol.conditions.size()
              << " conditions (" << wordOf(protocol.condition_order) << "), " << protocol.tasks.size()
              << " tasks (" << wordOf(protocol.task_order) << ")\n";
    for (const auto& [id, form] : folder.forms())
        std::cout << "form " << id << ": " << form.items().size() << " questions, " << form.language << "\n";
    for (const Group& group : protocol.groups)
        for (size_t place = 0; place < std::min<size_t>(group.wanted, 4); ++place) {
            std::cout << group.id << " " << place + 1 << ":";
            for (const PlannedSession& session : plannedSessions(protocol, group.id, place))
                std::cout << " " << session.condition << "/" << session.task;
            std::cout << "\n";
        }
    for (const Task& task : protocol.tasks)
        if (!task.scene.empty() && !std::filesystem::exists(task.scene))
            std::cout << "note: from here, there is no scene file " << task.scene << "\n";
    return 0;
}

int enrol(const Options& options) {
    StudyFolder folder(options.folder);
    const Participant person = folder.enrol(options.group, options.pseudonym);
    std::cout << person.pseudonym << "\n";
    return 0;
}

int next(const Options& options) {
    const StudyFolder folder(options.folder);
    const Participant person = folder.participant(options.pseudonym);
    std::cout << person.pseudonym << ", " << person.group << (person.has_withdrawn ? ", left early" : "")
              << "\n";
    for (const Session& session : person.sessions) {
        std::cout << session.uuid << "  " << titleOf(session)
                  << (folder.run(person, session.uuid) ? ", run noted" : "") << "\n";
        const Task* const task = taskOf(folder.protocol(), session.task);
        if (task && !task->scene.empty()) std::cout << "     scene " << task->scene << "\n";
        for (const Condition& condition : folder.protocol().conditions)
            if (condition.id == session.condition && !condition.options.empty())
                std::cout << "     options " << condition.options << "\n";
        std::cout << formLines(folder, person, session);
    }
    return 0;
}

int fill(const Options& options) {
    StudyFolder folder(options.folder);
    Answers answers = askedIn(folder, options.session, options.form);
    const bool is_finished = fillInTerminal(folder.form(options.form), answers, std::cin, std::cout,
                                            [&](const Answers& now) { folder.save(now); });
    return is_finished ? 0 : 1;
}

int page(const Options& options) {
    const StudyFolder folder(options.folder);
    const Answers answers = askedIn(folder, options.session, options.form);
    std::ifstream file(folder.path() / "forms" / (options.form + ".json"), std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    writePrivateFile(options.out, formPage(text, answers));
    return 0;
}

int import(const Options& options) {
    StudyFolder folder(options.folder);
    for (const std::string& file : options.files) {
        const Answers taken = folder.take(file, options.replaces);
        std::cout << file << ": " << taken.pseudonym << ", " << taken.form << ", " << taken.values.size()
                  << " answers\n";
    }
    return 0;
}

int attach(const Options& options) {
    StudyFolder folder(options.folder);
    const Participant person = folder.participantOf(options.session);
    const Task* const task = taskOf(folder.protocol(), person.find(options.session)->task);
    RunRecord run;
    run.session = options.session;
    run.scene = options.scene.empty() && task ? task->scene : options.scene;
    if (!std::filesystem::is_regular_file(run.scene))
        throw UserError("the scene file \"" + run.scene +
                        "\" cannot be read from here; name it with --scene");
    run.scene_sha256 = sha256OfFile(run.scene);
    run.programs = programVersion();
    run.recording = std::filesystem::path(options.recording).filename().string();
    if (!options.report.empty()) run.figures = figuresOfReport(options.report);
    folder.save(person.pseudonym, run);
    return 0;
}

int withdraw(const Options& options) {
    StudyFolder(options.folder).withdraw(options.pseudonym, options.reason);
    return 0;
}

int remove(const Options& options) {
    StudyFolder(options.folder).remove(options.pseudonym);
    std::cout << options.pseudonym
              << " is deleted from this folder. Copies, reports and recordings made before still "
              << "have the data: delete these, too.\n";
    return 0;
}

int report(const Options& options) {
    writeReport(StudyFolder(options.folder), options.out, programVersion());
    std::cout << options.out << "/report.md\n";
    return 0;
}

int plan(const Options& options) {
    Plan asked = options.plan;
    asked.first = options.groups[0];
    asked.second = options.groups[1];
    if (options.printed_p > 0) asked.p = options.printed_p;
    std::cout << planText(asked);
    return 0;
}

int agree(const Options& options) {
    std::cout << agreementText(options.files.front());
    return 0;
}

using Command = int (*)(const Options&);

void addPlan(CLI::App& word, Options& options) {
    word.add_option("--groups", options.groups, "people in each of the two groups")
        ->required()
        ->expected(2)
        ->check(CLI::Range(1, 100'000));
    word.add_option("--tests", options.plan.tests, "how many questions are tested")
        ->check(CLI::Range(1, 10'000));
    word.add_option("--alpha", options.plan.alpha, "accepted chance of a false alarm")
        ->check(within(1e-4, 0.5));
    word.add_option("--power", options.plan.power, "wanted chance to see a difference")
        ->check(within(0.5, 0.999));
    word.add_option("--p", options.printed_p, "a printed P of Student's test of these groups: what it says")
        ->check(within(1e-9, 0.999));
}

int run(int argc, char** argv) {
    umask(S_IRWXG | S_IRWXO);  // what people answered is the study's alone
    CLI::App app("User studies on the simulator: protocol, questionnaires, statistics, report", "study");
    Options options;
    Command chosen = nullptr;
    const auto add = [&](const char* word, const char* what, Command command) {
        CLI::App* const added = app.add_subcommand(word, what);
        added->callback([&chosen, command] { chosen = command; });
        return added;
    };
    const auto addIn = [&](const char* word, const char* what, Command command) {
        CLI::App* const added = add(word, what, command);
        added->add_option("STUDY", options.folder, "folder of the study")->required();
        return added;
    };
    const auto addSession = [&](CLI::App* word) {
        word->add_option("SESSION", options.session, "UUID, as next prints it")->required();
        return word;
    };
    const auto addPerson = [&](CLI::App* word) {
        word->add_option("PSEUDONYM", options.pseudonym, "as P001")->required();
        return word;
    };
    app.require_subcommand(1);
    addIn("init", "make a study: a protocol to be edited, and the questionnaires", init);
    addIn("check", "read protocol and forms, and say what they plan", check);
    CLI::App* const enrolling = addIn("enrol", "a new participant: pseudonym, order, sessions", enrol);
    enrolling->add_option("--group", options.group, "id of a group of the protocol")->required();
    enrolling->add_flag("--consent", options.has_consent, "the participant has consented")->required();
    enrolling->add_option("--pseudonym", options.pseudonym, "default: the next number, as P001");
    addPerson(addIn("next", "what a participant has done, and what comes next", next));
    addSession(addIn("fill", "answer a form here, line by line; it goes on where it was stopped", fill))
        ->add_option("FORM", options.form, "id of the form")
        ->required();
    CLI::App* const paging = addSession(addIn("page", "write a form as a page for a browser", page));
    paging->add_option("FORM", options.form, "id of the form")->required();
    paging->add_option("--out", options.out, "where to (.html)")->required();
    CLI::App* const importing = addIn("import", "take in the files that pages saved", import);
    importing->add_option("FILES", options.files, "files of answers")->required();
    importing->add_flag("--replace", options.replaces, "put them in the place of other answers");
    CLI::App* const attaching =
        addSession(addIn("attach", "note with what a session was run: scene, versions, rates", attach));
    attaching->add_option("--report", options.report, "what haptic_server wrote with --report");
    attaching->add_option("--scene", options.scene, "scene file; default: that of the task");
    attaching->add_option("--recording", options.recording, "name of the session's recording or trace");
    addPerson(addIn("withdraw", "a participant left early; answers so far stay", withdraw))
        ->add_option("--reason", options.reason, "in the participant's words, if told");
    addPerson(addIn("remove", "delete all that there is of a participant", remove));
    addIn("report", "write report.md, checklist.md, tables and analysis.R", report)
        ->add_option("--out", options.out, "folder")
        ->required();
    addPlan(*add("plan", "what a study of this size can see, and what many tests do to it", plan), options);
    add("agree", "agreement of raters: a table of numbers, one column per rater", agree)
        ->add_option("FILE", options.files, "CSV with a header")
        ->required()
        ->expected(1);
    if (!parseCommandLine(app, argc, argv, "study")) return 0;
    return chosen(options);
}

}  // namespace
}  // namespace bonemill::study

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::study::run(argc, argv); });
}

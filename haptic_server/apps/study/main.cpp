// study plans, asks, keeps and judges a user study on the simulator (docs/research/study.md).
#include <sys/stat.h>

#include "common/cli/command_line.h"
#include "common/process/run_program.h"
#include "haptic_server/apps/study/commands.h"

namespace bonemill::study {
namespace {

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

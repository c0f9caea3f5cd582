// bonemill_lab does what is done with files before and after a session: cases of scans, what is to be known
// of recordings, and how exact a scene's accuracy settings are here.
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <iostream>
#include <string>

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/cli/version.h"
#include "common/dds/network_cli.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "common/process/standard_output.h"
#include "common/rt/realtime.h"
#include "haptic_server/cases/casework/case_request.h"
#include "haptic_server/lab/accuracy_report/accuracy_report.h"
#include "haptic_server/lab/assess/assess_journal.h"
#include "haptic_server/lab/what_if/what_if.h"
#include "haptic_server/recording/export/export_journal.h"
#include "haptic_server/recording/rerun/verify_journal.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/server/replay/player.h"
#include "haptic_server/server/replay/replay_server.h"
#include "haptic_server/teaching/lessons/forget_person.h"

namespace bonemill {
namespace {

void addAssessOptions(CLI::App& app, AssessOptions& assess) {
    app.add_option("journal", assess.journal, "the recorded session (.mcap)")->required();
    app.add_option("--out", assess.out, "folder for results and reports")->required()->type_name("DIR");
}

void addForgetOptions(CLI::App& app, ForgetOptions& forget) {
    app.add_option("pseudonym", forget.pseudonym, "whose data it is, as in the class table")->required();
    app.add_option("--in", forget.folder, "folder of the class table")->required()->type_name("DIR");
    app.add_option("--recordings", forget.recordings,
                   "folder of the recordings; default: that of the class table")
        ->type_name("DIR");
}

void addReplayOptions(CLI::App& app, ReplayOptions& replay) {
    app.add_option("journal", replay.journal, "the recorded session (.mcap)")->required();
    app.add_option("--session", replay.session, "session number under which it is shown");
    app.add_option("--domain", replay.domain, "DDS domain, 0 to 230");
    dds::addNetworkOptions(app, replay.network);
    app.add_option("--at", replay.at_s, "begin at this moment, s")->check(within(0, kMaxSeconds));
    app.add_option("--speed", replay.speed, "so many times as fast as it was")
        ->check(within(Player::kSlowest, Player::kFastest))
        ->capture_default_str();
    app.add_flag("--paused", replay.is_paused, "wait until a viewer lets it go on");
    app.add_option("--stream-mbit-per-s", replay.stream_mbit_per_s,
                   "node meshes take this much of the network at most")
        ->check(within(0.1, 10000))
        ->capture_default_str();
    app.add_flag("--instructor-only", replay.instructor_only, "only instructors lead the replay");
    app.add_option("--against", replay.against.file,
                   "compare with another attempt at the same scene: a recording (.mcap), or a result (.json)")
        ->type_name("FILE");
    app.add_option("--against-attempt", replay.against.number,
                   "of a recording --against: its attempt's number, from 1; 0: the last one")
        ->check(within(0, 100000));
    app.add_option("--classes", replay.folders.classes,
                   "folder of the classes' folders: viewers may choose a result in it to compare with")
        ->type_name("DIR");
    app.add_option("--recordings", replay.folders.recordings, "folder of the recordings that results name")
        ->type_name("DIR");
}

void addExportOptions(CLI::App& app, ExportOptions& files) {
    app.add_option("journal", files.journal, "the recorded session (.mcap)")->required();
    app.add_option("--h5", files.h5, "write everything as HDF5, with units (docs/howto/replay.md)");
    app.add_option("--csv", files.csv, "write one CSV line per tick, as --trace does");
    app.add_option("--traj", files.traj, "write what went in, for simulate --trajectory");
    app.add_option("--tool-path", files.tool_path,
                   "write the tool's way in an attempt, for a scene's assessment.expert_path");
    app.add_option("--foxglove", files.foxglove,
                   "write what Foxglove shows (.mcap), and beside it a layout (docs/howto/foxglove.md)");
    auto* const align = app.add_option(
        "--align", files.align,
        "bring a table of another program (.csv) onto the session's clock (docs/reference/beacon.md)");
    app.add_option("--aligned", files.aligned, "of --align: file to write; default: FILE_aligned.csv")
        ->needs(align);
    app.add_option("--align-clock", files.align_clock,
                   "of --align: column with that program's time; default: the first one")
        ->needs(align);
    app.add_option("--attempt", files.attempt, "of --tool-path: its number, from 1; 0: the last one")
        ->check(within(0, 100000));
}

void addWhatIfOptions(CLI::App& app, WhatIfOptions& what_if) {
    app.add_option("journal", what_if.journal, "the recorded session (.mcap)")->required();
    app.add_option("--at", what_if.at_s, "from this moment of the session on, s")
        ->required()
        ->check(within(0, kMaxSeconds));
    app.add_option("--out", what_if.out,
                   "the other recording (.mcap); beside it go its page (.html) and figures (.json)")
        ->required()
        ->type_name("FILE");
    app.add_option("--shift-mm", what_if.shift_mm, "the hand elsewhere: X,Y,Z in frame W")
        ->expected(3)
        ->delimiter(',')
        ->check(within(-100, 100));
    app.add_option("--tool", what_if.tool, "another tool of the scene: its name, or number from 1");
    app.add_option("--accuracy", what_if.accuracy, "another preset, or contact law, by its name");
    app.add_option("--pace", what_if.pace, "the hand so many times as fast")->check(within(0.1, 10));
    app.add_flag("--expert", what_if.is_experts, "the hand is the expert's of the scene's task");
}

void addReportOptions(CLI::App& app, AccuracyReportOptions& report) {
    app.add_option("--scene", report.scene, "scene file (.textproto)")->required();
    app.add_option("--out", report.out,
                   "folder for report.md, accuracy.csv, accuracy.json, patch.csv, pareto.png")
        ->required();
    app.add_option(
        "--setting", report.settings,
        "measure this one beside the scene's own, by its name in the report (exact, fast, ...); may be "
        "given more than once; default: all");
    app.add_option("--budget-us", report.budget_us,
                   "propose the most accurate setting whose ticks (p99.9) fit this many microseconds")
        ->check(within(1e-3, 1e6));
}

// As hexOf() writes it. Throws UserError.
std::string linkOf(std::string hex) {
    std::ranges::transform(hex, hex.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    constexpr size_t kDigits = 64;
    if (!hex.empty() &&
        (hex.size() != kDigits || hex.find_first_not_of("0123456789abcdef") != std::string::npos))
        throw UserError("--chain " + hex + ": a link has 64 hexadecimal digits (0 to 9, a to f)");
    return hex;
}

int verify(const std::string& journal, const std::string& noted_link) {
    const JournalVerdict verdict = verifyJournal(journal, versionText(), linkOf(noted_link));
    std::cout << journal << ": " << verdict.text() << std::flush;
    return verdict.isProven() ? 0 : 1;
}

int printSeries(const std::string& folder) {
    for (const std::string& line : listSeries(folder)) std::cout << line << '\n';
    std::cout << std::flush;
    return 0;
}

// What a session leaves, and a case, say of people: they are their user's alone.
void keepFilesPrivate() {
    umask(S_IRWXG | S_IRWXO);
}

struct Options {
    std::string log_level = "info";
    AccuracyReportOptions report;
    ReplayOptions replay;
    CaseRequest request;
    std::string series_folder;
    ForgetOptions forget;
    AssessOptions assess;
    WhatIfOptions what_if;
    std::string journal, noted_link;
    ExportOptions files;
};

// What the called subcommand does; returns the exit code.
using Run = std::function<int()>;

CLI::App& add(CLI::App& above, const std::string& name, const std::string& about, Run& chosen,
              const Run& run) {
    CLI::App* const command = above.add_subcommand(name, about);
    command->callback([&chosen, run] { chosen = run; });
    return *command;
}

void addFileCommands(CLI::App& app, Options& options, Run& chosen) {
    addReportOptions(
        add(app, "accuracy-report",
            "measure errors and tick times of the accuracy settings in a scene, on this machine", chosen,
            [&] {
                keepFreedHeap();  // each stroke of its hand has a tick of its own
                std::cout << accuracyReport(options.report, std::cerr) << std::flush;
                return 0;
            }),
        options.report);
    addReplayOptions(
        add(app, "replay", "show a recorded session again, as a live one (docs/howto/replay.md)", chosen,
            [&] {
                const int exit_code = runReplay(options.replay);
                forgiveUnprinted();
                return exit_code;
            }),
        options.replay);
    addCaseOptions(add(app, "make-case", "make a training case of a scan (docs/howto/cases.md)", chosen,
                       [&] {
                           keepFilesPrivate();
                           makeCase(options.request, versionText(), std::cout);
                           return 0;
                       }),
                   options.request);
    add(app, "list-series", "print which DICOM series a folder holds, and which is the best for bone", chosen,
        [&] { return printSeries(options.series_folder); })
        .add_option("FOLDER", options.series_folder, "folder of DICOM files")
        ->required();
}

void addSessionCommands(CLI::App& session, Options& options, Run& chosen) {
    session.require_subcommand(1);
    addForgetOptions(
        add(session, "forget", "delete what a class' folder holds of one person, and say what was deleted",
            chosen, [&] { return forgetPerson(options.forget, std::cout); }),
        options.forget);
    addAssessOptions(add(session, "assess",
                         "measure and judge the attempts of a recording anew (docs/reference/assessment.md)",
                         chosen, [&] { return assessJournal(options.assess, std::cout); }),
                     options.assess);
    addWhatIfOptions(
        add(session, "what-if",
            "go on otherwise from a moment on, and judge that beside what happened (docs/howto/replay.md)",
            chosen,
            [&] {
                whatIf(options.what_if, std::cout);
                return 0;
            }),
        options.what_if);
    CLI::App& verifying = add(session, "verify", "run a recording again and compare every bit", chosen,
                              [&] { return verify(options.journal, options.noted_link); });
    verifying.add_option("JOURNAL", options.journal, "recording (.mcap)")->required();
    verifying
        .add_option("--chain", options.noted_link,
                    "a link that was kept apart: of the class table, a result, a report or the server's log")
        ->type_name("HEX");
    addExportOptions(add(session, "export", "write a recorded session as files for other programs", chosen,
                         [&] {
                             exportJournal(options.files);
                             return 0;
                         }),
                     options.files);
}

int runLab(int argc, char** argv) {
    runReaderIfCalled(argc, argv);
    setReaderProgram("/proc/self/exe");
    CLI::App app("What is done with files before and after a session", "bonemill_lab");
    app.require_subcommand(1);
    Options options;
    options.replay.version = options.what_if.version = versionText();
    Run chosen;
    addLogLevelOption(app, options.log_level);
    addFileCommands(app, options, chosen);
    CLI::App* const session = app.add_subcommand("session", "what can be done with what sessions have left");
    addSessionCommands(*session, options, chosen);
    if (!parseCommandLine(app, argc, argv, "bonemill_lab")) return 0;
    setUpLog("bonemill_lab", options.log_level);
    if (session->parsed()) keepFilesPrivate();
    return chosen();
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::runLab(argc, argv); });
}

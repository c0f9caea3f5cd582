// haptic_server owns the bone, runs the haptic loop, shows the result to all clients.
#include <sys/stat.h>

#include <iostream>

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/cli/number_range.h"
#include "common/cli/version.h"
#include "common/dds/network_cli.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "haptic_server/cases/casework/case_options.h"
#include "haptic_server/cases/casework/make_case.h"
#include "haptic_server/lab/accuracy_report/accuracy_report.h"
#include "haptic_server/lab/offline/assess_journal.h"
#include "haptic_server/lab/offline/describe_scene.h"
#include "haptic_server/lab/offline/simulate.h"
#include "haptic_server/recording/export/export_journal.h"
#include "haptic_server/recording/rerun/verify_journal.h"
#include "haptic_server/scans/import/import_options_text.h"
#include "haptic_server/scans/import/import_program.h"
#include "haptic_server/server/replay/player.h"
#include "haptic_server/server/replay/replay_server.h"
#include "haptic_server/server/session/server.h"
#include "haptic_server/teaching/lessons/forget_person.h"

namespace bonemill {
namespace {

void addSaveOptions(CLI::App& app, SavePaths& save) {
    app.add_option("--save-volume", save.volume, "at the end: the densities (.nrrd)");
    app.add_option("--save-mesh", save.mesh, "at the end: the surface (.stl or .ply, mm)");
    app.add_option(
        "--save-difference", save.difference,
        "at the end: what was removed (positive) and added (negative) (.nrrd, docs/research/simulate.md)");
}

void addServerOptions(CLI::App& app, ServerOptions& server) {
    app.add_option("--scene", server.scene, "scene file (.textproto)");
    app.add_option(
        "--scenes", server.scene_folders,
        "folder of scenes that clients can choose from, may be given again; default: that of --scene");
    app.add_option("--session", server.session, "session number: names the device link and the topics");
    app.add_option("--domain", server.domain, "DDS domain, 0 to 230");
    dds::addNetworkOptions(app, server.network);
    app.add_option("--from", server.from,
                   "go on from that moment of a recording: FILE.mcap@SECONDS (docs/teach/replay.md)");
    app.add_option("--seconds", server.seconds,
                   "stop this long after the first tick; 0: run until SIGINT or SIGTERM")
        ->check(within(0, kMostSeconds));
    app.add_option(
        "--accuracy", server.accuracy,
        "accuracy.json of accuracy-report, to show errors; default: SCENE.accuracy.json if it exists");
    app.add_option("--stream-mbit-per-s", server.stream_mbit_per_s,
                   "node meshes take this much of the network at most, those nearest to the burr first")
        ->check(within(0.1, 10000))
        ->capture_default_str();
    auto* const recording =
        app.add_option("--recording", server.recording,
                       "folder for what every session leaves of itself (docs/lab/recording.md); default: "
                       "$XDG_STATE_HOME/bonemill/recordings");
    app.add_flag("!--no-recording", server.is_recorded, "leave no recording")->excludes(recording);
    app.add_flag("--record-results", server.records_results,
                 "record what the ticks came to as well, which a replay finds again");
    app.add_flag("--resume", server.resumes,
                 "go on with the bone of this session if it was stopped before its end; else begin anew");
    app.add_option("--trace", server.trace, "write one CSV line per tick");
    app.add_option("--report", server.report, "write the run's statistics as JSON");
    addSaveOptions(app, server.save);
    app.add_option("--export-dir", server.export_dir,
                   "folder for what clients' export commands write while the session runs");
    app.add_option(
        "--class-table", server.class_table,
        "CSV file to which each attempt of a trainee adds a line; default: class.csv in --export-dir");
    app.add_flag("--until-device-leaves", server.until_device_leaves,
                 "stop when device_daemon shuts down in order");
    app.add_flag("--instructor-only", server.instructor_only,
                 "carry out commands of instructors only, for examinations");
    addRealtimeOptions(app, "the haptic thread", server.is_strict_realtime, server.rt_core);
}

void addSimulateOptions(CLI::App& app, SimulateOptions& simulate) {
    app.add_option("--scene", simulate.scene, "scene file (.textproto)")->required();
    app.add_option("--trajectory", simulate.trajectory,
                   "device poses: t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons")
        ->required();
    app.add_option("--tool", simulate.tool, "name of the scene's tool, or its number; default: the first")
        ->type_name("NAME|NUMBER");
    app.add_option("--trace", simulate.trace, "write one CSV line per tick");
    app.add_option(
        "--save-deviation", simulate.deviation,
        "at the end: picture of what was cut too far and not far enough by the scene's task (.png)");
    app.add_option(
        "--assess", simulate.assess,
        "at the end: results and report into this folder, as a session writes them beside the class table");
    app.add_option("--pseudonym", simulate.pseudonym, "whose results they are")->capture_default_str();
    addSaveOptions(app, simulate.save);
}

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
    app.add_option("--at", replay.at_s, "begin at this moment, s")->check(within(0, kMostSeconds));
    app.add_option("--speed", replay.speed, "so many times as fast as it was")
        ->check(within(Player::kSlowest, Player::kFastest))
        ->capture_default_str();
    app.add_flag("--paused", replay.is_paused, "wait until a viewer lets it go on");
    app.add_option("--stream-mbit-per-s", replay.stream_mbit_per_s,
                   "node meshes take this much of the network at most")
        ->check(within(0.1, 10000))
        ->capture_default_str();
    app.add_flag("--instructor-only", replay.instructor_only, "only instructors lead the replay");
}

void addExportOptions(CLI::App& app, ExportOptions& files) {
    app.add_option("journal", files.journal, "the recorded session (.mcap)")->required();
    app.add_option("--h5", files.h5, "write everything as HDF5, with units (docs/teach/replay.md)");
    app.add_option("--csv", files.csv, "write one CSV line per tick, as --trace does");
    app.add_option("--traj", files.traj, "write what went in, for simulate --trajectory");
    app.add_option("--tool-path", files.tool_path,
                   "write the tool's way in an attempt, for a scene's assessment.expert_path");
    app.add_option("--attempt", files.attempt, "of --tool-path: its number, from 1; 0: the last one")
        ->check(within(0, 100000));
}

void addReportOptions(CLI::App& app, AccuracyReportOptions& report) {
    app.add_option("--scene", report.scene, "scene file (.textproto)")->required();
    app.add_option("--out", report.out,
                   "folder for report.md, accuracy.csv, accuracy.json, patch.csv, pareto.png")
        ->required();
    app.add_option("--budget-us", report.budget_us,
                   "propose the most accurate setting whose ticks (p99.9) fit this many microseconds")
        ->check(within(1e-3, 1e6));
}

struct Options {
    std::string log_level = "info";
    bool describe = false;
    bool list_scenes = false;
    ServerOptions server;
    SimulateOptions simulate;
    AccuracyReportOptions report;
    ForgetOptions forget;
    AssessOptions assess;
    ReplayOptions replay;
    ExportOptions files;
    CaseRequest request;
    std::string journal;
    std::string series_folder;
};

int simulateInOrder(const SimulateOptions& options) {
    const SimulateResult result = simulate(options);
    std::cout << result.json << std::endl;
    for (const std::string& problem : result.problems) std::cerr << "error: " << problem << '\n';
    return result.problems.empty() ? 0 : 1;
}

int verifyInOrder(const std::string& journal) {
    const JournalVerdict verdict = verifyJournal(journal, versionText());
    std::cout << journal << ": " << verdict.text() << std::flush;
    return verdict.isProven() ? 0 : 1;
}

int printSeries(const std::string& folder) {
    for (const std::string& line : listSeries(folder)) std::cout << line << '\n';
    std::cout << std::flush;
    return 0;
}

// What a session leaves says who did what: it is its user's alone.
void keepFilesPrivate() {
    umask(S_IRWXG | S_IRWXO);
}

int serveLive(const Options& options) {
    const bool has_folders = !options.server.scene_folders.empty();
    if (options.server.scene.empty() && (!has_folders || options.describe) && options.server.from.empty())
        throw UserError("no scene given; use --scene FILE (see deploy/scenes)" +
                        std::string(options.describe ? "" : ", or --scenes FOLDER"));
    if (options.list_scenes) {
        std::cout << listScenesOf(options.server);
        return 0;
    }
    if (!options.describe) {
        keepFilesPrivate();
        return runServer(options.server);
    }
    std::cout << describeScene(options.server.scene);
    return 0;
}

int serve(int argc, char** argv) {
    runReaderIfCalled(argc, argv);
    setReaderProgram("/proc/self/exe");
    CLI::App app("Haptic bone-milling server", "haptic_server");
    Options options;
    addServerOptions(app, options.server);
    app.add_flag("--describe-scene", options.describe, "print what the scene says and what runs, then stop");
    app.add_flag("--list-scenes", options.list_scenes, "print which scenes can be chosen, then stop");
    addLogLevelOption(app, options.log_level);
    CLI::App* const simulate_command =
        app.add_subcommand("simulate", "run a recorded trajectory as fast as possible, deterministic");
    addSimulateOptions(*simulate_command, options.simulate);
    CLI::App* const report_command = app.add_subcommand(
        "accuracy-report",
        "measure errors and tick times of the accuracy settings in a scene, on this machine");
    addReportOptions(*report_command, options.report);
    CLI::App* const replay_command =
        app.add_subcommand("replay", "show a recorded session again, as a live one (docs/teach/replay.md)");
    addReplayOptions(*replay_command, options.replay);
    CLI::App* const case_command =
        app.add_subcommand("make-case", "make a training case of a scan (docs/teach/cases.md)");
    addCaseOptions(*case_command, options.request);
    CLI::App* const series_command = app.add_subcommand(
        "list-series", "print which DICOM series a folder holds, and which is the best for bone");
    series_command->add_option("FOLDER", options.series_folder, "folder of DICOM files")->required();
    CLI::App* const session_command =
        app.add_subcommand("session", "what can be done with what sessions have left")->require_subcommand(1);
    CLI::App* const forget_command = session_command->add_subcommand(
        "forget", "delete what a class' folder holds of one person, and say what was deleted");
    addForgetOptions(*forget_command, options.forget);
    CLI::App* const assess_command = session_command->add_subcommand(
        "assess", "measure and judge the attempts of a recording anew (docs/teach/assessment.md)");
    addAssessOptions(*assess_command, options.assess);
    CLI::App* const verify_command =
        session_command->add_subcommand("verify", "run a recording again and compare every bit");
    verify_command->add_option("JOURNAL", options.journal, "recording (.mcap)")->required();
    CLI::App* const export_command =
        session_command->add_subcommand("export", "write a recorded session as files for other programs");
    addExportOptions(*export_command, options.files);
    if (!parseCommandLine(app, argc, argv, "haptic_server")) return 0;
    options.server.version = options.replay.version = versionText();
    setUpLog("haptic_server", options.log_level);
    if (session_command->parsed()) keepFilesPrivate();
    if (assess_command->parsed()) return assessJournal(options.assess, std::cout);
    if (forget_command->parsed()) return forgetPerson(options.forget, std::cout);
    if (export_command->parsed()) {
        exportJournal(options.files);
        return 0;
    }
    if (series_command->parsed()) return printSeries(options.series_folder);
    if (case_command->parsed()) {
        keepFilesPrivate();
        makeCase(options.request, versionText(), std::cout);
        return 0;
    }
    if (replay_command->parsed()) return runReplay(options.replay);
    if (verify_command->parsed()) return verifyInOrder(options.journal);
    if (simulate_command->parsed()) return simulateInOrder(options.simulate);
    if (!report_command->parsed()) return serveLive(options);
    std::cout << accuracyReport(options.report, std::cerr) << std::flush;
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::serve(argc, argv); });
}

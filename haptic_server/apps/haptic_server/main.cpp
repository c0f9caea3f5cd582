// haptic_server owns the bone, runs the haptic loop, shows the result to all clients.
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <string>

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/cli/version.h"
#include "common/dds/network_cli.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "common/process/standard_output.h"
#include "haptic_server/lab/describe/describe_scene.h"
#include "haptic_server/lab/simulate/simulate.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/server/session/server.h"

namespace bonemill {
namespace {

[[noreturn]] void becomeLab(const std::string& command, char** argv) {
    std::error_code error;
    const std::filesystem::path lab =
        std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "bonemill_lab";
    std::cerr << "haptic_server: " << command << " is a command of bonemill_lab, which does it now"
              << std::endl;
    execv(lab.c_str(), argv);
    throw UserError(lab.string() + ": cannot be run; it must lie beside haptic_server for " + command +
                    " (builds with BONEMILL_WITH_SCANS=OFF have none)");
}

// Adds them to the app's help. The first of them in the command line ends parsing: the program becomes the
// bonemill_lab beside it, with the same words, and says so on stderr. Throws UserError if there is none.
void addLabCommands(CLI::App& app, char** argv) {
    const auto add = [&](const std::string& name, const std::string& about) {
        app.add_subcommand(name, about)->preparse_callback([name, argv](size_t) { becomeLab(name, argv); });
    };
    add("accuracy-report",
        "measure errors and tick times of the accuracy settings in a scene, on this machine");
    add("replay", "show a recorded session again, as a live one (docs/howto/replay.md)");
    add("make-case", "make a training case of a scan (docs/howto/cases.md)");
    add("list-series", "print which DICOM series a folder holds, and which is the best for bone");
    add("session", "what can be done with what sessions have left");
}

void addSaveOptions(CLI::App& app, SavePaths& save) {
    app.add_option("--save-volume", save.volume, "at the end: the densities (.nrrd)");
    app.add_option("--save-mesh", save.mesh, "at the end: the surface (.stl or .ply, mm)");
    app.add_option(
        "--save-difference", save.difference,
        "at the end: what was removed (positive) and added (negative) (.nrrd, docs/reference/simulate.md)");
}

void addServerOptions(CLI::App& app, ServerOptions& server) {
    app.add_option("--scene", server.scene, "scene file (.textproto)");
    app.add_option(
        "--scenes", server.scene_folders,
        "folder of scenes that clients can choose from, may be given again; default: that of --scene");
    app.add_option("--launcher", server.maker.program,
                   "bonemill: makes what the scenes of --makes lack when one is chosen (bonemill prepare)");
    app.add_option("--makes", server.maker.ids, "name of a scene for --launcher, may be given again")
        ->allow_extra_args(false);
    app.add_option("--session", server.session, "session number: names the device link and the topics");
    app.add_option("--domain", server.domain, "DDS domain, 0 to 230");
    dds::addNetworkOptions(app, server.network);
    app.add_option("--from", server.from,
                   "go on from that moment of a recording: FILE.mcap@SECONDS (docs/howto/replay.md)");
    app.add_option("--seconds", server.seconds,
                   "stop this long after the first tick; 0: run until SIGINT or SIGTERM")
        ->check(within(0, kMaxSeconds));
    app.add_option(
        "--accuracy", server.accuracy,
        "accuracy.json of accuracy-report, to show errors; default: SCENE.accuracy.json if it exists");
    app.add_option("--stream-mbit-per-s", server.stream_mbit_per_s,
                   "node meshes take this much of the network at most, those nearest to the burr first")
        ->check(within(0.1, 10000))
        ->capture_default_str();
    auto* const recording = app.add_option(
        "--recording", server.recording,
        "folder for what every session leaves of itself (docs/reference/recording.md); default: "
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
    auto* const beacon = app.add_option(
        "--beacon", server.beacon,
        "tell the session's clock to ADDRESS:PORT five times per second (docs/reference/beacon.md)");
    app.add_flag("--beacon-broadcast", server.allows_broadcast, "of --beacon: the address may be all PCs'")
        ->needs(beacon);
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
    app.add_option(
           "--set", simulate.settings,
           "set a field of the scene, may be given again: coupling.max_speed_mm_per_s=80, an effect is had "
           "by effects.thermal={} and taken away by effects.thermal=")
        ->type_name("PATH=VALUE")
        ->allow_extra_args(false);
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

struct Options {
    std::string log_level = "info";
    bool describe = false;
    bool list_scenes = false;
    ServerOptions server;
    SimulateOptions simulate;
    std::string sweep;
};

int simulateInOrder(const SimulateOptions& options, const std::string& sweep) {
    if (!sweep.empty()) {
        std::cout << simulateSweep(options, readSweep(sweep));
        return 0;
    }
    const SimulateResult result = simulate(options);
    std::cout << result.json << std::endl;
    for (const std::string& problem : result.problems) std::cerr << "error: " << problem << '\n';
    return result.problems.empty() ? 0 : 1;
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
        umask(S_IRWXG | S_IRWXO);  // what a session leaves says who did what: it is its user's alone
        const int exit_code = runServer(options.server);
        forgiveUnprinted();
        return exit_code;
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
    simulate_command
        ->add_option("--sweep", options.sweep,
                     "run once with each value of a field of the scene, and print a table")
        ->type_name("PATH=VALUE,VALUE,...");
    addLabCommands(app, argv);
    if (!parseCommandLine(app, argc, argv, "haptic_server")) return 0;
    options.server.version = versionText();
    setUpLog("haptic_server", options.log_level);
    return simulate_command->parsed() ? simulateInOrder(options.simulate, options.sweep) : serveLive(options);
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::serve(argc, argv); });
}

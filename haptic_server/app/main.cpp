// haptic_server owns the bone, runs the haptic loop, shows the result to all clients.
#include <CLI/CLI.hpp>
#include <iostream>

#include "common/dds/network_cli.h"
#include "common/log/log.h"
#include "common/user_error.h"
#include "haptic_server/accuracy_report/accuracy_report.h"
#include "haptic_server/offline/describe_scene.h"
#include "haptic_server/offline/simulate.h"
#include "haptic_server/session/server.h"

namespace {

// Every wrong argument leaves with the code of bad input.
int exitCodeOf(const CLI::App& app, const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : bonemill::kUserErrorExitCode;
}

void addSaveOptions(CLI::App& app, bonemill::SavePaths& save) {
    app.add_option("--save-volume", save.volume, "at the end: the densities (.nrrd)");
    app.add_option("--save-mesh", save.mesh, "at the end: the surface (.stl or .ply, mm)");
    app.add_option("--save-difference", save.difference,
                   "at the end: what was removed (positive) and added (negative) (.nrrd, docs/simulate.md)");
}

void addServerOptions(CLI::App& app, bonemill::ServerOptions& server) {
    app.add_option("--scene", server.scene, "scene file (.textproto)");
    app.add_option("--session", server.session, "session number: names the device link and the topics");
    app.add_option("--domain", server.domain, "DDS domain, 0 to 230");
    bonemill::dds::addNetworkOptions(app, server.network);
    app.add_option("--seconds", server.seconds,
                   "stop this long after the first tick; 0: run until SIGINT or SIGTERM");
    app.add_option(
        "--accuracy", server.accuracy,
        "accuracy.json of accuracy-report, to show errors; default: SCENE.accuracy.json if it exists");
    app.add_option("--stream-mbit-per-s", server.stream_mbit_per_s,
                   "node meshes take this much of the network at most, those nearest to the burr first")
        ->check(CLI::Range(0.1, 10000.0))
        ->capture_default_str();
    app.add_option("--trace", server.trace, "write one CSV line per tick");
    app.add_option("--report", server.report, "write the run's statistics as JSON");
    addSaveOptions(app, server.save);
    app.add_option("--export-dir", server.export_dir,
                   "folder for what clients' export commands write while the session runs");
    app.add_option("--rt-core", server.rt_core, "core of the haptic thread; -1: any");
    app.add_flag("--until-device-leaves", server.until_device_leaves,
                 "stop when device_daemon shuts down in order");
    app.add_flag("--instructor-only", server.instructor_only,
                 "carry out commands of instructors only, for examinations");
    app.add_flag("--best-effort-rt", server.best_effort_rt, "go on without real-time permissions");
}

void addSimulateOptions(CLI::App& app, bonemill::SimulateOptions& simulate) {
    app.add_option("--scene", simulate.scene, "scene file (.textproto)")->required();
    app.add_option("--trajectory", simulate.trajectory,
                   "device poses: t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons")
        ->required();
    app.add_option("--tool", simulate.tool, "name of the scene's tool, or its number; default: the first")
        ->type_name("NAME|NUMBER");
    app.add_option("--trace", simulate.trace, "write one CSV line per tick");
    addSaveOptions(app, simulate.save);
}

void addReportOptions(CLI::App& app, bonemill::AccuracyReportOptions& report) {
    app.add_option("--scene", report.scene, "scene file (.textproto)")->required();
    app.add_option("--out", report.out,
                   "folder for report.md, accuracy.csv, accuracy.json, patch.csv, pareto.png")
        ->required();
    app.add_option("--budget-us", report.budget_us,
                   "propose the most accurate setting whose ticks (p99.9) fit this many microseconds")
        ->check(CLI::PositiveNumber);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Haptic bone-milling server", "haptic_server");
    std::string log_level = "info";
    bool describe = false;
    bonemill::ServerOptions server;
    bonemill::SimulateOptions simulate;
    bonemill::AccuracyReportOptions report;
    addServerOptions(app, server);
    app.add_flag("--describe-scene", describe, "print what the scene says and what runs, then stop");
    app.add_option("--log-level", log_level, "trace, debug, info, warn, error, off");
    CLI::App* simulate_command =
        app.add_subcommand("simulate", "run a recorded trajectory as fast as possible, deterministic");
    addSimulateOptions(*simulate_command, simulate);
    CLI::App* report_command = app.add_subcommand(
        "accuracy-report",
        "measure errors and tick times of the accuracy settings in a scene, on this machine");
    addReportOptions(*report_command, report);
    try {
        app.parse(argc, argv);
        bonemill::setUpLog("haptic_server", log_level);
        if (simulate_command->parsed()) {
            const bonemill::SimulateResult result = bonemill::simulate(simulate);
            std::cout << result.json << std::endl;
            for (const std::string& problem : result.problems) std::cerr << "error: " << problem << '\n';
            return result.problems.empty() ? 0 : 1;
        }
        if (report_command->parsed()) {
            std::cout << bonemill::accuracyReport(report, std::cerr) << std::flush;
            return 0;
        }
        if (server.scene.empty())
            throw bonemill::UserError("no scene given; use --scene FILE (see deploy/scenes)");
        if (describe) {
            std::cout << bonemill::describeScene(server.scene);
            return 0;
        }
        return bonemill::runServer(server);
    } catch (const CLI::ParseError& error) {
        return exitCodeOf(app, error);
    } catch (const bonemill::UserError& error) {
        std::cerr << "error: " << error.what() << '\n';
        return bonemill::kUserErrorExitCode;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 1;
    }
}

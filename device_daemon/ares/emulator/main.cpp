// ares_emulator is an ARES with its motion controller and a hand on it, none of them real
// (docs/reference/ares.md).
#include <iostream>

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/config/scene_file.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "common/process/standard_output.h"
#include "device_daemon/ares/emulator/emulator.h"

namespace bonemill {
namespace {

// Returns nothing after --help, which is already printed. Throws UserError.
std::optional<EmulatorOptions> parseOptions(int argc, char** argv) {
    EmulatorOptions options;
    std::vector<std::string> faults;
    CLI::App app{
        "Emulated ARES with its motion controller and a simulated hand; device_daemon drives it over UDP."};
    app.footer(faultHelp());
    app.add_option("--scene", options.scene, "Scene file (.textproto)")->required();
    app.add_option("--port", options.port, "UDP port to listen on (0: any free one)")->capture_default_str();
    app.add_option("--address", options.address, "IPv4 address of this machine to listen on")
        ->capture_default_str();
    app.add_option("--host-port", options.host_port,
                   "Listen to nobody but this port of this PC (0: to any host)");
    app.add_option("--rate", options.rate_hz, "States per second (default: the scene's loop.rate_hz)")
        ->check(within(100, 10000));
    app.add_option("--seconds", options.seconds, "Leave after this much of the scenario, in s")
        ->check(within(1e-3, kMaxSeconds));
    app.add_flag("--hold", options.hold, "Rest at the last waypoint instead of leaving");
    app.add_option("--watchdog-ms", options.watchdog_ms,
                   "The motors brake when the host is silent for so long, unless it asks for another time")
        ->check(within(2, 30))
        ->capture_default_str();
    app.add_flag("--unhomed", options.is_unhomed, "Begin with a zero that must be found");
    app.add_option("--fault", faults, "A fault to have (see below)");
    app.add_option("--seed", options.seed, "Chooses the packets that faults befall")->capture_default_str();
    addRealtimeOptions(app, "the controller's loop", options.is_strict_realtime, options.core);
    addLogLevelOption(app, options.log_level);
    addParentOption(app, options.parent);
    if (!parseCommandLine(app, argc, argv, "ares_emulator")) return std::nullopt;
    for (const std::string& fault : faults) options.faults.push_back(faultSpecOf(fault));
    return options;
}

Scenario loadScenario(const std::string& file) {
    const LoadedScene loaded = loadScene(file);
    try {
        return scenarioOf(loaded.scene);
    } catch (const UserError& error) {
        throw UserError(file + ": " + error.what());
    }
}

int emulate(int argc, char** argv) {
    const auto options = parseOptions(argc, argv);
    if (!options) return 0;
    if (options->parent) endWithParent(*options->parent);
    setUpLog("ares_emulator", options->log_level);
    const Scenario scenario = loadScenario(options->scene);
    const StopSignals stop_signals;
    listenToHandOrders();
    Emulator emulator(scenario, *options, stop_signals);
    std::cout << "listening on " << wire::textOf(emulator.local()) << std::endl;
    emulator.run();
    std::cout << jsonLineOf(emulator.statistics()) << std::endl;
    forgiveUnprinted();
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::emulate(argc, argv); });
}

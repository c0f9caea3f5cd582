#include "device_daemon/ares/emulator/emulator_options.h"

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/cli/number_range.h"

namespace bonemill {

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

}  // namespace bonemill

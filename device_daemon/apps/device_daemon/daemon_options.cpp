#include "device_daemon/apps/device_daemon/daemon_options.h"

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/cli/number_range.h"
#include "common/dds/network_cli.h"
#include "device_daemon/apps/device_daemon/device_choice.h"
#include "device_daemon/device_setup/stop_files.h"

namespace bonemill {

std::optional<DaemonOptions> parseOptions(int argc, char** argv) {
    DaemonOptions options;
    options.stop_dir = defaultStopDir();
    CLI::App app{
        "Gives haptic_server the hand: reads the haptic device, and gives it the force, within its limits."};
    app.add_option("--scene", options.scene,
                   "Scene file (.textproto) for as long as no haptic_server says which scene is in force; "
                   "without it the "
                   "daemon waits for that");
    app.add_option("--device", options.device, deviceChoices())->capture_default_str();
    app.add_option("--session", options.session, "Number that haptic_server was started with")
        ->capture_default_str();
    app.add_option("--domain", options.domain,
                   "DDS domain of the viewers whose mouse holds the tool, 0 to 230")
        ->check(CLI::Range(0, 230))
        ->capture_default_str();
    dds::addNetworkOptions(app, options.network);
    app.add_option("--seconds", options.seconds, "Leave after so many s with haptic_server")
        ->check(within(1e-3, kMaxSeconds));
    app.add_option(
           "--wait-seconds", options.wait_seconds,
           "Leave with an error if haptic_server has not answered after so many s (default: wait for ever)")
        ->check(within(1e-3, kMaxSeconds));
    app.add_flag("--hold", options.hold, "The scripted hand rests at its last waypoint instead of leaving");
    app.add_flag("!--no-enabling-switch", options.has_enabling_switch,
                 "The device has no switch that must be held: it engages by itself while the force is small");
    app.add_option("--pedal", options.pedal,
                   "A foot pedal or key beside the device: its path in /dev/input, see --list");
    app.add_flag("--list", options.list, "Print which devices are there, and why others are not, and end");
    app.add_flag("--describe", options.describe,
                 "Print geometry, frames and limits of the scene's ARES, and end");
    app.add_option("--stop-dir", options.stop_dir,
                   "Folder for the last two seconds before every stop, as CSV files")
        ->capture_default_str();
    addRealtimeOptions(app, "the device loop", options.is_strict_realtime, options.core);
    addLogLevelOption(app, options.log_level);
    if (!parseCommandLine(app, argc, argv, "device_daemon")) return std::nullopt;
    if (options.scene.empty() && options.describe)
        throw UserError("--describe needs a scene: --scene FILE (see device_daemon --help)");
    return options;
}

}  // namespace bonemill

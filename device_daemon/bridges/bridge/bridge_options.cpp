#include "device_daemon/bridges/bridge/bridge_options.h"

#include <filesystem>

#include "common/cli/command_line.h"
#include "common/cli/number_range.h"

namespace bonemill::bridge {
namespace {

void addOptions(CLI::App& app, BridgeOptions& options) {
    app.add_option("--port", options.port, "UDP port that device_daemon speaks to; 0 takes any free one")
        ->capture_default_str();
    app.add_option("--address", options.address, "Address of this PC to listen on")->capture_default_str();
    app.add_option("--host-port", options.host_port,
                   "Listen to nobody but this port of this PC (0: to any host)");
    app.add_option("--library", options.library, "The vendor's library, if it is not where it is searched");
    app.add_option("--device", options.device, "Number or name of the arm; default: the first");
    app.add_option("--max-force-n", options.max_force, "Give no more than this; default: what the arm can")
        ->check(within(1e-3, 1e3));
    app.add_flag("--probe", options.probe,
                 "Load the library, open the arm, say what there is and leave; gives no force");
    CLI::Option* self_test = app.add_flag("--self-test", options.self_test,
                                          "Measure rate and jitter of the arm, without device_daemon");
    app.add_flag("--ramp", options.ramp, "With --self-test: push up with 0.5 N and back, after you typed yes")
        ->needs(self_test);
    app.add_option("--seconds", options.seconds, "How long the self-test lasts")
        ->check(within(0.1, 3600))
        ->needs(self_test)
        ->capture_default_str();
    addRealtimeOptions(app, "the arm's loop", options.is_strict_realtime, options.core);
    addParentOption(app, options.parent);
}

}  // namespace

std::optional<BridgeOptions> parseBridgeOptions(int argc, char** argv, const std::string& about,
                                                const std::function<void(CLI::App&)>& add) {
    BridgeOptions options;
    CLI::App app{about};
    addOptions(app, options);
    if (add) add(app);
    if (!parseCommandLine(app, argc, argv, std::filesystem::path(argv[0]).filename())) return std::nullopt;
    return options;
}

}  // namespace bonemill::bridge

#include "device_daemon/app/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <thread>

#include "common/user_error.h"

namespace bonemill {

int defaultCore() noexcept {
    return std::max(-1, static_cast<int>(std::thread::hardware_concurrency()) - 2);
}

std::optional<DaemonOptions> parseOptions(int argc, char** argv) {
    DaemonOptions options;
    CLI::App app{
        "Simulated ARES haptic device with a simulated hand; haptic_server answers it through shared "
        "memory."};
    app.add_option("--scene", options.scene, "Scene file (.textproto)")->required();
    app.add_option("--session", options.session, "Number that haptic_server was started with")
        ->capture_default_str();
    app.add_option("--seconds", options.seconds, "Leave after this much of the scenario, in s")
        ->check(CLI::PositiveNumber);
    app.add_option(
           "--wait-seconds", options.wait_seconds,
           "Leave with an error if haptic_server has not answered after so many s (default: wait for ever)")
        ->check(CLI::PositiveNumber);
    app.add_flag("--hold", options.hold, "Rest at the last waypoint instead of leaving");
    app.add_flag("--best-effort-rt", options.best_effort_realtime,
                 "Go on without real-time scheduling and locked memory");
    app.add_option("--rt-core", options.core, "Processor core for the device loop (-1: any)")
        ->check(CLI::Range(-1, 4095))
        ->capture_default_str();
    app.add_option("--log-level", options.log_level, "trace, debug, info, warn, error or off")
        ->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        std::cout << app.help();
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        throw UserError(std::string(error.what()) + " (see device_daemon --help)");
    }
    return options;
}

}  // namespace bonemill

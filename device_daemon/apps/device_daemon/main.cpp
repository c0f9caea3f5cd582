// device_daemon is the device side of the simulator (docs/howto/device.md).
#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>

#include <iostream>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/dds/network_cli.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "common/process/standard_output.h"
#include "device_daemon/apps/device_daemon/daemon.h"
#include "device_daemon/apps/device_daemon/device_choice.h"
#include "device_daemon/ares/ares_device/ares_settings.h"
#include "device_daemon/control/device_loop/black_box.h"

namespace bonemill {
namespace {

// Returns nothing after --help, which is already printed. Throws UserError.
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

std::string percentilesOf(const LatencyHistogram& histogram) {
    return fmt::format(R"({{"p50":{:.1f},"p99":{:.1f},"p99_9":{:.1f},"max":{:.1f}}})",
                       microsecondsOfNs(double(histogram.percentileNs(50))),
                       microsecondsOfNs(double(histogram.percentileNs(99))),
                       microsecondsOfNs(double(histogram.percentileNs(99.9))),
                       microsecondsOfNs(double(histogram.maxNs())));
}

// Returns one JSON object on one line, with the units in the names. `device_words` is a JSON object with
// which the device's own program has ended; it goes along as "device" unless it is empty.
std::string jsonLineOf(const LoopStatistics& s, const std::string& device_words) {
    const double rate_hz = s.wall_time > 0 ? double(s.ticks) / s.wall_time : 0;
    const bool is_object =
        device_words.size() > 1 && device_words.front() == '{' && device_words.back() == '}';
    return fmt::format(
        R"({{"ticks":{},"missed_periods":{},"wall_s":{:.3f},"rate_hz":{:.2f},"period_us":{},)"
        R"("wakeup_latency_us":{},"compute_us":{},"attached_ticks":{},"late_answers":{},"engaged_ticks":{},)"
        R"("max_force_n":{:.4f},"max_torque_nmm":{:.3f},"clamped_ticks":{},"rate_limited_ticks":{},)"
        R"("stops":{},"unheard_periods":{},"final_state":"{}"{}}})",
        s.ticks, s.missed_periods, s.wall_time, rate_hz, percentilesOf(s.period),
        percentilesOf(s.wakeup_latency), percentilesOf(s.compute_time), s.attached_ticks, s.late_answers,
        s.engaged_ticks, s.max_force, kPerMilli * s.max_torque, s.clamped_ticks, s.rate_limited_ticks,
        s.stops, s.unheard_periods, s.final_state, is_object ? ",\"device\":" + device_words : "");
}

// It ends with a goodbye wherever it ends, also while it waits for the next scene.
struct Leaving {
    DeviceLink& link;
    DaemonMemory& memory;
    ~Leaving() {
        memory.between.reset();
        sayGoodbye(link, memory);
    }
};

// Each scene has its own loop; what the device is and has found out stays unless the scene says what it is.
void serve(const DaemonOptions& options, SceneFollower& scenes, DeviceLink& link,
           const StopSignals& stop_signals) {
    DaemonMemory memory;
    const Leaving leaving{link, memory};
    std::optional<ChosenDevice> chosen;
    std::string device_words;
    while (const std::optional<FollowedScene> scene = scenes.next()) {
        if (chosen && chosen->is_of_scene) chosen.reset();
        if (!chosen) chosen = chooseDevice(*scene, options);
        DaemonOptions of_run = options;
        if (chosen->leaves_by_itself) of_run.seconds.reset();
        Daemon daemon(*scene, of_run, *chosen->device, chosen->program.get(), stop_signals, link, memory);
        if (daemon.run() == Daemon::End::kLeft) break;
    }
    if (chosen && chosen->program) device_words = chosen->program->finish();
    std::cout << jsonLineOf(memory.statistics, device_words) << std::endl;
}

int runDaemon(int argc, char** argv) {
    const auto options = parseOptions(argc, argv);
    if (!options) return 0;
    if (options->list) {
        std::cout << deviceTable(foundDevices()) << std::flush;
        return 0;
    }
    setUpLog("device_daemon", options->log_level);
    std::optional<FollowedScene> own;
    if (!options->scene.empty()) own = followedSceneOf(options->scene);
    if (options->describe) {
        std::cout << describe(own->setup.ares) << std::flush;
        return 0;
    }
    umask(S_IRWXG | S_IRWXO);  // what a stop leaves behind is its user's alone
    const StopSignals stop_signals;
    dds::setNetwork(options->network, dds::NetworkPart::kDevice, options->session);
    DeviceLink link = DeviceLink::create(options->session, LinkSide::kDaemon);
    SceneFollower scenes(std::move(own), *options, link, stop_signals);
    serve(*options, scenes, link, stop_signals);
    forgiveUnprinted();
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::runDaemon(argc, argv); });
}

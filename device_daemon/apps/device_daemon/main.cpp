// device_daemon is the device side of the simulator (docs/lab/device.md).
#include <sys/stat.h>

#include <iostream>
#include <optional>

#include "common/base/user_error.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "common/rt/stop_signals.h"
#include "device_daemon/apps/device_daemon/daemon.h"
#include "device_daemon/apps/device_daemon/device_choice.h"
#include "device_daemon/apps/device_daemon/found_devices.h"
#include "device_daemon/ares/ares_device/describe_ares.h"

namespace bonemill {
namespace {

// It ends with a goodbye wherever it ends, also while it waits for the next scene.
struct Leaving {
    DeviceLink& link;
    DaemonMemory& memory;
    ~Leaving() { sayGoodbye(link, memory); }
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
    dds::setNetwork(options->network, dds::NetworkPart::kDevice);
    DeviceLink link = DeviceLink::create(options->session, LinkSide::kDaemon);
    SceneFollower scenes(std::move(own), *options, link, stop_signals);
    serve(*options, scenes, link, stop_signals);
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::runDaemon(argc, argv); });
}

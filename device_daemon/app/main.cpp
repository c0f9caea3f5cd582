// device_daemon is the device side of the simulator (docs/device.md).
#include <iostream>

#include "common/config/scene_file.h"
#include "common/log/log.h"
#include "common/rt/stop_signals.h"
#include "common/run_program.h"
#include "common/user_error.h"
#include "device_daemon/app/daemon.h"
#include "device_daemon/app/device_choice.h"
#include "device_daemon/app/found_devices.h"
#include "device_daemon/ares/describe_ares.h"

namespace bonemill {
namespace {

DeviceSetup loadSetup(const std::string& file) {
    const LoadedScene loaded = loadScene(file);
    try {
        return deviceSetupOf(loaded.scene);
    } catch (const UserError& error) {
        throw UserError(file + ": " + error.what());
    }
}

int runDaemon(int argc, char** argv) {
    auto options = parseOptions(argc, argv);
    if (!options) return 0;
    if (options->list) {
        std::cout << deviceTable(foundDevices()) << std::flush;
        return 0;
    }
    setUpLog("device_daemon", options->log_level);
    const DeviceSetup setup = loadSetup(options->scene);
    if (options->describe) {
        std::cout << describe(setup.ares) << std::flush;
        return 0;
    }
    const StopSignals stop_signals;
    dds::setNetwork(options->network);
    const ChosenDevice chosen = chooseDevice(setup, *options);
    if (chosen.leaves_by_itself) options->seconds.reset();
    Daemon daemon(setup, *options, *chosen.device, chosen.program.get(), stop_signals);
    daemon.run();
    const std::string device_words = chosen.program ? chosen.program->finish() : "";
    std::cout << jsonLineOf(daemon.statistics(), device_words) << std::endl;
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::runDaemon(argc, argv); });
}

// device_daemon is the device side of the simulator (docs/device.md).
#include <signal.h>

#include <iostream>

#include "common/config/scene_file.h"
#include "common/log/log.h"
#include "common/user_error.h"
#include "device_daemon/app/daemon.h"
#include "device_daemon/app/device_choice.h"
#include "device_daemon/app/found_devices.h"
#include "device_daemon/ares/describe_ares.h"

namespace {

bonemill::DeviceSetup loadSetup(const std::string& file) {
    const bonemill::LoadedScene loaded = bonemill::loadScene(file);
    try {
        return bonemill::deviceSetupOf(loaded.scene);
    } catch (const bonemill::UserError& error) {
        throw bonemill::UserError(file + ": " + error.what());
    }
}

// Every thread inherits it: the watcher takes the signals when it is ready for them.
void blockStopSignals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        auto options = bonemill::parseOptions(argc, argv);
        if (!options) return 0;
        if (options->list) {
            std::cout << bonemill::deviceTable(bonemill::foundDevices()) << std::flush;
            return 0;
        }
        bonemill::setUpLog("device_daemon", options->log_level);
        const bonemill::DeviceSetup setup = loadSetup(options->scene);
        if (options->describe) {
            std::cout << bonemill::describe(setup.ares) << std::flush;
            return 0;
        }
        blockStopSignals();
        bonemill::dds::setNetwork(options->network);
        const bonemill::ChosenDevice chosen = bonemill::chooseDevice(setup, *options);
        if (chosen.leaves_by_itself) options->seconds.reset();
        bonemill::Daemon daemon(setup, *options, *chosen.device, chosen.program.get());
        daemon.run();
        const std::string device_words = chosen.program ? chosen.program->finish() : "";
        std::cout << bonemill::jsonLineOf(daemon.statistics(), device_words) << std::endl;
        return 0;
    } catch (const bonemill::UserError& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return bonemill::kUserErrorExitCode;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return 1;
    }
}

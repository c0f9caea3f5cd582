// ares_emulator is an ARES with its motion controller and a hand on it, none of them real (docs/device.md).
#include <signal.h>

#include <iostream>

#include "common/config/scene_file.h"
#include "common/log/log.h"
#include "common/user_error.h"
#include "device_daemon/emulator/emulator.h"

namespace {

bonemill::Scenario loadScenario(const std::string& file) {
    const bonemill::LoadedScene loaded = bonemill::loadScene(file);
    try {
        return bonemill::scenarioOf(loaded.scene);
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
        const auto options = bonemill::parseOptions(argc, argv);
        if (!options) return 0;
        bonemill::setUpLog("ares_emulator", options->log_level);
        const bonemill::Scenario scenario = loadScenario(options->scene);
        blockStopSignals();
        bonemill::Emulator emulator(scenario, *options);
        std::cout << "listening on " << bonemill::wire::textOf(emulator.local()) << std::endl;
        emulator.run();
        std::cout << bonemill::jsonLineOf(emulator.statistics()) << std::endl;
        return 0;
    } catch (const bonemill::UserError& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return bonemill::kUserErrorExitCode;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return 1;
    }
}

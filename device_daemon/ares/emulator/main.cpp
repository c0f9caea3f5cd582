// ares_emulator is an ARES with its motion controller and a hand on it, none of them real
// (docs/lab/device.md).
#include <iostream>

#include "common/base/user_error.h"
#include "common/config/scene_file.h"
#include "common/log/log.h"
#include "common/process/end_with_parent.h"
#include "common/process/hand_order.h"
#include "common/process/run_program.h"
#include "common/rt/stop_signals.h"
#include "device_daemon/ares/emulator/emulator.h"

namespace bonemill {
namespace {

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
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::emulate(argc, argv); });
}

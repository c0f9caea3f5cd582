// render_client shows a session (docs/viewer.md).
#include <iostream>

#include "common/log/log.h"
#include "common/user_error.h"
#include "render_client/app/measure_viewer.h"
#include "render_client/app/offscreen_viewer.h"
#include "render_client/app/send_command.h"
#include "render_client/app/stop_signal.h"
#include "render_client/app/window_viewer.h"

int main(int argc, char** argv) {
    try {
        const auto options = bonemill::parseOptions(argc, argv);
        if (!options) return 0;
        bonemill::setUpLog("render_client", options->log_level);
        bonemill::dds::setNetwork(options->network);
        bonemill::catchStopSignals();
        if (options->command) return bonemill::runSendCommand(*options);
        if (options->measure) {
            bonemill::runMeasurement(*options);
        } else if (options->offscreen) {
            bonemill::runOffscreen(*options);
        } else {
            bonemill::runWindow(*options);
        }
        return 0;
    } catch (const bonemill::UserError& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return bonemill::kUserErrorExitCode;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << std::endl;
        return 1;
    }
}

// render_client shows a session (docs/teach/viewer.md).
#include <iostream>

#include "common/log/log.h"
#include "common/process/run_program.h"
#include "render_client/apps/render_client/connect_gateway.h"
#include "render_client/apps/render_client/list_sessions.h"
#include "render_client/apps/render_client/measure_viewer.h"
#include "render_client/apps/render_client/offscreen_viewer.h"
#include "render_client/apps/render_client/run_relay.h"
#include "render_client/apps/render_client/send_command.h"
#include "render_client/apps/render_client/serve_gateway.h"
#include "render_client/apps/render_client/stop_signal.h"
#include "render_client/apps/render_client/video_viewer.h"
#include "render_client/apps/render_client/window_viewer.h"
#include "render_client/viewer_options/connect_options.h"

namespace bonemill {
namespace {

// Mesa crashes where it gets no memory to draw and to compile shaders in.
constexpr size_t kPictureBytes = size_t(1) << 30;

int view(int argc, char** argv) {
    auto options = parseOptions(argc, argv);
    hideTokens(argc, argv);
    if (!options) return 0;
    setUpLog("render_client", options->log_level);
    catchStopSignals();
    if (options->relay) return runRelay(*options);
    dds::setNetwork(options->network);
    if (options->connect) connectToGateway(*options);
    if (options->lists_sessions) return runListSessions(*options);
    if (options->serve) return runGateway(*options);
    if (options->command) return runSendCommand(*options);
    requireMemory(kPictureBytes, "the pictures");
    if (options->measure) {
        runMeasurement(*options);
    } else if (options->offscreen && options->offscreen->video) {
        runVideo(*options);
    } else if (options->offscreen) {
        runOffscreen(*options);
    } else {
        runWindow(*options);
    }
    return 0;
}

}  // namespace
}  // namespace bonemill

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return bonemill::view(argc, argv); });
}

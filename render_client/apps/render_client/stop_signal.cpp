#include "render_client/apps/render_client/stop_signal.h"

#include <csignal>

namespace bonemill {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

}  // namespace

void catchStopSignals() {
    struct sigaction action {};
    action.sa_handler = [](int) { stop_requested = 1; };
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool stopRequested() noexcept {
    return stop_requested != 0;
}

}  // namespace bonemill

#include "common/rt/stop_signals.h"

#include <algorithm>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

// The kernel gives a blocked signal also to a process that ignores it.
bool isHangupIgnored() noexcept {
    struct sigaction action {};
    return sigaction(SIGHUP, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

StopSignals::StopSignals() noexcept {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    if (!isHangupIgnored()) sigaddset(&signals_, SIGHUP);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

int StopSignals::await(int64_t timeout_ns) const noexcept {
    const timespec timeout = timespecOfNs(timeout_ns);
    return std::max(0, sigtimedwait(&signals_, nullptr, &timeout));
}

}  // namespace bonemill

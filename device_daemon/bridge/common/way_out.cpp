#include "device_daemon/bridge/common/way_out.h"

#include <signal.h>
#include <unistd.h>

#include <string_view>

#include "common/rt/clock.h"

namespace bonemill::bridge {
namespace {

constexpr int64_t kLookEveryNs = 20 * kNsPerMillisecond;

sigset_t stopSignals() noexcept {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, number);
    return signals;
}

[[noreturn]] void leaveLibraryBehind() noexcept {
    constexpr std::string_view kText = "error: the vendor's library does not return; leaving without it\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kText.data(), kText.size());
    _exit(kStuckExitCode);
}

}  // namespace

WayOut::WayOut() {
    const sigset_t signals = stopSignals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    signal(SIGPIPE, SIG_IGN);  // that nobody reads what is printed is no reason to leave force behind
    thread_ = std::thread([this] { watch(); });
}

WayOut::~WayOut() {
    is_over_ = true;
    thread_.join();
}

void WayOut::begin() noexcept {
    int64_t none = 0;
    deadline_ns_.compare_exchange_strong(none, monotonicNowNs() + kTimeToLeaveNs);
}

void WayOut::watch() noexcept {
    const sigset_t signals = stopSignals();
    const timespec limit = timespecOfNs(kLookEveryNs);
    while (!is_over_) {
        if (sigtimedwait(&signals, nullptr, &limit) > 0) {
            is_requested_ = true;
            begin();
        }
        if (deadline_ns_ != 0 && monotonicNowNs() > deadline_ns_) leaveLibraryBehind();
    }
}

}  // namespace bonemill::bridge

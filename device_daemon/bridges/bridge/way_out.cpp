#include "device_daemon/bridges/bridge/way_out.h"

#include <signal.h>
#include <unistd.h>

#include <string_view>

#include "common/rt/clock.h"

namespace bonemill::bridge {
namespace {

constexpr int64_t kLookEveryNs = 20 * kNsPerMillisecond;

[[noreturn]] void leaveLibraryBehind() noexcept {
    constexpr std::string_view kText = "error: the vendor's library does not return; leaving without it\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kText.data(), kText.size());
    _exit(kStuckExitCode);
}

}  // namespace

WayOut::WayOut() {
    signal(SIGPIPE, SIG_IGN);  // that no process reads what is printed is no reason to leave force behind
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
    while (!is_over_) {
        if (stop_signals_.await(kLookEveryNs)) {
            is_requested_ = true;
            begin();
        }
        if (deadline_ns_ != 0 && monotonicNowNs() > deadline_ns_) leaveLibraryBehind();
    }
}

}  // namespace bonemill::bridge

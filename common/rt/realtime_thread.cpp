#include "common/rt/realtime_thread.h"

#include <unistd.h>

#include <future>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

struct Started {
    pid_t id;
    RealtimeReport report;
};

std::string refusalOf(const std::string& what, const RealtimeReport& report) {
    std::string message = "this machine does not let " + what + " be real-time:";
    for (const std::string& missing : report.missing) message += " " + missing;
    return message + " Type deploy/check-realtime, which says what to do, or leave out --strict-rt.";
}

}  // namespace

RealtimeThread::RealtimeThread(const RealtimeThreadConfig& config, std::function<void()> work,
                               const std::function<void(const RealtimeReport&)>& tell) {
    RealtimeReport report = lockMemory();
    std::promise<Started> has_started;
    std::promise<bool> permission;
    std::future<Started> started = has_started.get_future();
    thread_ =
        std::jthread([request = config.request, work = std::move(work), has_started = std::move(has_started),
                      permission = permission.get_future()]() mutable {
            has_started.set_value({gettid(), makeThreadRealtime(request)});
            if (permission.get()) work();
        });
    Started thread = started.get();
    id_ = thread.id;
    report.append(thread.report);
    const bool is_accepted = report.missing.empty() || !config.is_strict;
    try {
        if (is_accepted) tell(report);
    } catch (...) {
        permission.set_value(false);  // or no caller could stop the thread that is left
        throw;
    }
    permission.set_value(is_accepted);
    if (!is_accepted) throw UserError(refusalOf(config.what, report));
}

}  // namespace bonemill

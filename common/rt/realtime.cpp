#include "common/rt/realtime.h"

#include <alloca.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <future>
#include <sstream>
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

std::string firstLineOf(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return line;
}

// Tells whether a kernel list such as "2-3,6" holds this core.
bool listHoldsCore(const std::string& list, int core) {
    std::istringstream ranges(list);
    for (std::string range; std::getline(ranges, range, ',');) {
        int first = 0;
        int last = 0;
        const int found = std::sscanf(range.c_str(), "%d-%d", &first, &last);
        if (found < 1) continue;
        if (core >= first && core <= (found == 2 ? last : first)) return true;
    }
    return false;
}

// This is advice, not a failure: the thread runs where it should, but not alone.
void checkCore(int core, RealtimeReport& report) {
    const std::string name = "core " + std::to_string(core);
    if (!listHoldsCore(firstLineOf("/sys/devices/system/cpu/isolated"), core)) {
        report.advice.push_back("This thread shares " + name + " with other threads: boot with isolcpus=" +
                                std::to_string(core) + " to keep them away.");
    }
}

void checkGovernor(int core, RealtimeReport& report) {
    const int shown_core = core == kAnyCore ? 0 : core;
    const std::string governor =
        firstLineOf("/sys/devices/system/cpu/cpu" + std::to_string(shown_core) + "/cpufreq/scaling_governor");
    if (!governor.empty() && governor != "performance") {
        report.advice.push_back("Core " + std::to_string(shown_core) + " runs with the frequency governor '" +
                                governor +
                                "': 'performance' avoids slow first microseconds after each sleep.");
    }
}

void checkKernel(RealtimeReport& report) {
    if (firstLineOf("/sys/kernel/realtime") != "1") {
        report.advice.push_back(
            "The kernel is not PREEMPT_RT (Debian package linux-image-rt-amd64): single wake-ups may come "
            "late.");
    }
}

void pin(int core, RealtimeReport& report) {
    if (core < 0 || core >= CPU_SETSIZE || core >= sysconf(_SC_NPROCESSORS_CONF)) {
        report.missing.push_back("The thread is not pinned: this machine has no core " +
                                 std::to_string(core) + ".");
        return;
    }
    cpu_set_t cores;
    CPU_ZERO(&cores);
    CPU_SET(size_t(core), &cores);
    if (const int error = pthread_setaffinity_np(pthread_self(), sizeof(cores), &cores)) {
        report.missing.push_back("The thread is not pinned to core " + std::to_string(core) + " (" +
                                 std::strerror(error) + ").");
        return;
    }
    checkCore(core, report);
}

void schedule(int priority, RealtimeReport& report) {
    sched_param parameters{};
    parameters.sched_priority = priority;
    const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
    if (error == 0) return;
    std::string sentence =
        "No SCHED_FIFO at priority " + std::to_string(priority) + " (" + std::strerror(error) + ")";
    if (error == EPERM) {
        sentence += ": raise 'rtprio' for this user (docs/howto/realtime.md says how)";
    }
    report.missing.push_back(sentence + "; other programs can delay every tick.");
}

bool hasCapability(int bit) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("CapEff:")) return (std::stoull(line.substr(7), nullptr, 16) >> bit & 1u) != 0;
    }
    return false;
}

// Below a finite limit mlockall may be granted now and make every later allocation fail: worse than no lock.
bool mayLockAnything() {
    constexpr int kCapIpcLock = 14;  // linux/capability.h
    rlimit limit{};
    return hasCapability(kCapIpcLock) ||
           (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
}

}  // namespace

int coreFromLast(int n) noexcept {
    return std::max(kAnyCore, int(std::thread::hardware_concurrency()) - 1 - n);
}

void RealtimeReport::append(const RealtimeReport& other) {
    missing.insert(missing.end(), other.missing.begin(), other.missing.end());
    advice.insert(advice.end(), other.advice.begin(), other.advice.end());
}

RealtimeReport makeThreadRealtime(const RealtimeRequest& request) {
    RealtimeReport report;
    if (request.core != kAnyCore) pin(request.core, report);
    schedule(request.priority, report);
    checkGovernor(request.core, report);
    checkKernel(report);
    prefaultStack();
    return report;
}

void keepFreedHeap() noexcept {
    mallopt(M_TRIM_THRESHOLD, -1);
    mallopt(M_MMAP_MAX, 0);
}

RealtimeReport lockMemory() {
    RealtimeReport report;
    keepFreedHeap();
    std::string reason;
    if (!mayLockAnything()) {
        reason = "the limit is not 'unlimited'";
    } else if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
        reason = std::string("mlockall: ") + std::strerror(errno);
    }
    if (!reason.empty()) {
        report.missing.push_back(
            "Memory is not locked (" + reason +
            "): set 'memlock' to unlimited for this user (docs/howto/realtime.md says how); "
            "a page fault can delay a tick by milliseconds.");
    }
    return report;
}

[[gnu::noinline]] void prefaultStack() noexcept {
    volatile char* const pages = static_cast<volatile char*>(alloca(kPrefaultedStackBytes));
    constexpr size_t kMinPage = 4096;
    for (size_t i = 0; i < kPrefaultedStackBytes; i += kMinPage) pages[i] = 0;
}

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

std::optional<PageFaults> pageFaultsOf(pid_t thread) {
    std::ifstream file("/proc/self/task/" + std::to_string(thread) + "/stat");
    std::string line;
    if (!std::getline(file, line)) return std::nullopt;
    // The name stands in parentheses and may hold anything. After it come the state, six numbers, flags,
    // minflt, cminflt and majflt.
    std::istringstream rest(line.substr(line.rfind(')') + 1));
    std::string skipped;
    for (int n = 0; n < 7; ++n) rest >> skipped;
    PageFaults faults;
    uint64_t minor_of_children = 0;
    rest >> faults.minor >> minor_of_children >> faults.major;
    return rest ? std::optional(faults) : std::nullopt;
}

}  // namespace bonemill

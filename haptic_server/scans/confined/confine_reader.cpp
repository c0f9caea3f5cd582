#include "haptic_server/scans/confined/confine_reader.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <memory>

#include "common/base/user_error.h"
#include "haptic_server/scans/confined/sanitized.h"

namespace bonemill {
namespace {

// What a kernel, or this machine's kind, does not have is left out. Further calls are allowed with some
// arguments only, see loadFilter().
constexpr const char* kAllowed[] = {
    // memory of its own
    "brk", "mmap", "munmap", "mprotect", "mremap", "madvise",
    // files and folders that are read
    "read", "readv", "pread64", "lseek", "close", "poll", "ppoll", "stat", "fstat", "lstat", "newfstatat",
    "statx", "statfs", "fstatfs", "access", "faccessat", "faccessat2", "readlink", "readlinkat", "getcwd",
    "getdents64", "fadvise64",
    // its threads
    "futex", "rseq", "set_robust_list", "sched_yield", "sched_getaffinity", "exit",
    // its signals, and its end
    "rt_sigaction", "rt_sigprocmask", "rt_sigreturn", "sigaltstack", "restart_syscall", "exit_group",
    // what time it is, and who and where this is
    "clock_gettime", "clock_getres", "clock_nanosleep", "nanosleep", "gettimeofday", "time", "times",
    "getrusage", "sysinfo", "uname", "getpid", "getppid", "gettid", "getuid", "geteuid", "getgid", "getegid",
    "getrandom"};

// Root may still read the files of others.
bool dropCapabilities() {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct data[2]{};
    if (syscall(SYS_capget, &header, data) != 0) return false;
    const uint32_t kept = data[0].permitted & (1u << CAP_DAC_READ_SEARCH);
    data[0] = {kept, kept, 0};
    data[1] = {0, 0, 0};
    return syscall(SYS_capset, &header, data) == 0;
}

bool closeAllBut(int pipe) {
    constexpr unsigned kFirst = STDERR_FILENO + 1;
    const auto kept = unsigned(pipe);
    return kept >= kFirst && (kept == kFirst || close_range(kFirst, kept - 1, 0) == 0) &&
           close_range(kept + 1, UINT_MAX, 0) == 0;
}

// Where neither is granted the filter alone keeps it from them. Root would lose, in a user namespace, the
// right to read the files of others, and needs none.
void leaveIpcOfOthers() {
    if (unshare(CLONE_NEWIPC) != 0 && geteuid() != 0) [[maybe_unused]]
        const int is_granted = unshare(CLONE_NEWUSER | CLONE_NEWIPC);
}

void setLimits() {
    constexpr rlim_t kMaxFiles = 256;  // at once
    const auto set = [](auto resource, rlim_t most) {
        const rlimit limit{most, most};
        setrlimit(resource, &limit);
    };
    rlimit files{};
    if (getrlimit(RLIMIT_NOFILE, &files) == 0 && files.rlim_max > kMaxFiles) set(RLIMIT_NOFILE, kMaxFiles);
    set(RLIMIT_FSIZE, 0);
    set(RLIMIT_MSGQUEUE, 0);
    set(RLIMIT_MEMLOCK, 0);
}

class CallFilter {
  public:
    CallFilter()
        : filter_(seccomp_init(SCMP_ACT_ERRNO(EPERM)), seccomp_release), is_whole_(filter_ != nullptr) {}

    // Several with conditions for one call: each of them will do.
    template <class... Conditions>
    void allow(const char* call, Conditions... conditions) {
        add(SCMP_ACT_ALLOW, call, conditions...);
    }
    void beUnknown(const char* call) { add(SCMP_ACT_ERRNO(ENOSYS), call); }
    bool load() { return is_whole_ && seccomp_load(filter_.get()) == 0; }

  private:
    template <class... Conditions>
    void add(uint32_t action, const char* call, Conditions... conditions) {
        const int number = seccomp_syscall_resolve_name(call);
        if (!is_whole_ || number == __NR_SCMP_ERROR) return;
        is_whole_ =
            seccomp_rule_add(filter_.get(), action, number, sizeof...(conditions), conditions...) == 0;
    }

    std::unique_ptr<void, decltype(&seccomp_release)> filter_;
    bool is_whole_;
};

constexpr scmp_datum_t kInt = 0xffffffff;  // the kernel looks at no more of an int

void allowOpeningToRead(CallFilter& filter) {
    constexpr auto kNotForReading = scmp_datum_t(O_ACCMODE | O_CREAT | O_TRUNC);
    filter.allow("open", SCMP_A1(SCMP_CMP_MASKED_EQ, kNotForReading, O_RDONLY));
    filter.allow("openat", SCMP_A2(SCMP_CMP_MASKED_EQ, kNotForReading, O_RDONLY));
}

bool loadFilter(int pipe) {
    CallFilter filter;
    for (const char* call : kAllowed) filter.allow(call);
    allowOpeningToRead(filter);
    for (const int written : {STDOUT_FILENO, STDERR_FILENO, pipe}) {
        filter.allow("write", SCMP_A0(SCMP_CMP_MASKED_EQ, kInt, scmp_datum_t(written)));
        filter.allow("writev", SCMP_A0(SCMP_CMP_MASKED_EQ, kInt, scmp_datum_t(written)));
    }
    // A sanitizer asks a pipe of its own whether memory can be read.
    if (kIsSanitized)
        for (const char* call : {"pipe", "pipe2", "write"}) filter.allow(call);
    for (const unsigned command : {unsigned(FIONREAD), unsigned(TCGETS)})
        filter.allow("ioctl", SCMP_A1(SCMP_CMP_MASKED_EQ, kInt, command));
    for (const int command : {F_GETFD, F_SETFD, F_GETFL})
        filter.allow("fcntl", SCMP_A1(SCMP_CMP_MASKED_EQ, kInt, scmp_datum_t(command)));
    filter.allow("prctl", SCMP_A0(SCMP_CMP_MASKED_EQ, kInt, PR_SET_NAME));
    // Threads, and no processes. The flags of the newer calls lie in memory, where a filter cannot look; the
    // C library then takes the older ones.
    filter.allow("clone", SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD));
    for (const char* call : {"clone3", "openat2"}) filter.beUnknown(call);
    // This process may end itself, and look at its own limits and lower them.
    filter.allow("tgkill", SCMP_A0(SCMP_CMP_MASKED_EQ, kInt, scmp_datum_t(getpid())));
    filter.allow("prlimit64", SCMP_A0(SCMP_CMP_EQ, 0));
    return filter.load();
}

}  // namespace

void confineReader(int pipe) {
    leaveIpcOfOthers();
    setLimits();
    if (!closeAllBut(pipe) || prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || !dropCapabilities() ||
        !loadFilter(pipe))
        throw UserError("this kernel cannot confine the process that reads scans (seccomp)");
}

}  // namespace bonemill

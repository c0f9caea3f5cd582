#include "haptic_server/scans/confined/import_limits.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <fstream>
#include <memory>
#include <optional>

#include "common/base/user_error.h"
#include "common/process/work_ahead.h"
#include "haptic_server/core/kernels/brick_layout.h"
#include "haptic_server/scans/confined/free_memory.h"

namespace bonemill {
namespace {

// Calls that are not in this kernel's or this library's list of calls are left out.
constexpr const char* kForbidden[] = {
    // the network
    "socket", "socketpair", "connect", "bind", "listen", "accept", "accept4",
    // other programs and processes
    "execve", "execveat", "fork", "vfork", "ptrace", "process_vm_readv", "process_vm_writev", "kill", "tkill",
    "rt_sigqueueinfo", "rt_tgsigqueueinfo", "setpriority", "ioprio_set", "sched_setaffinity", "sched_setattr",
    "sched_setparam", "sched_setscheduler", "migrate_pages", "move_pages", "process_madvise",
    "process_mrelease", "pidfd_open", "pidfd_getfd", "pidfd_send_signal", "kcmp", "setns", "unshare",
    // what is written into folders
    "creat", "truncate", "rename", "renameat", "renameat2", "unlink", "unlinkat", "mkdir", "mkdirat", "rmdir",
    "link", "linkat", "symlink", "symlinkat", "mknod", "mknodat", "chmod", "fchmod", "fchmodat", "chown",
    "fchown", "lchown", "fchownat", "setxattr", "lsetxattr", "fsetxattr", "removexattr", "lremovexattr",
    "fremovexattr", "utime", "utimes", "utimensat", "futimesat",
    // file systems
    "mount", "umount2", "pivot_root", "chroot", "move_mount", "open_tree", "fsopen", "fsconfig", "fsmount",
    "mount_setattr", "swapon", "swapoff", "quotactl", "name_to_handle_at", "open_by_handle_at",
    // the kernel
    "bpf", "perf_event_open", "init_module", "finit_module", "delete_module", "kexec_load", "kexec_file_load",
    "reboot", "iopl", "ioperm", "personality", "acct", "syslog", "userfaultfd", "io_uring_setup",
    "io_uring_enter", "io_uring_register", "keyctl", "add_key", "request_key", "settimeofday",
    "clock_settime", "adjtimex", "clock_adjtime", "sethostname", "setdomainname",
    // who this is
    "setuid", "setgid", "setreuid", "setregid", "setresuid", "setresgid", "setgroups", "setfsuid", "setfsgid",
    "capset", "seccomp"};

// Root may still read the files of others, as before.
bool dropCapabilities() {
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct data[2]{};
    if (syscall(SYS_capget, &header, data) != 0) return false;
    const uint32_t kept = data[0].permitted & (1u << CAP_DAC_READ_SEARCH);
    data[0] = {kept, kept, 0};
    data[1] = {0, 0, 0};
    return syscall(SYS_capset, &header, data) == 0;
}

class CallFilter {
  public:
    CallFilter() : filter_(seccomp_init(SCMP_ACT_ALLOW), seccomp_release), is_whole_(filter_ != nullptr) {}

    template <class... Conditions>
    void refuse(const char* call, int error, Conditions... conditions) {
        const int number = seccomp_syscall_resolve_name(call);
        if (!is_whole_ || number == __NR_SCMP_ERROR) return;
        is_whole_ = seccomp_rule_add(filter_.get(), SCMP_ACT_ERRNO(uint32_t(error)), number,
                                     sizeof...(conditions), conditions...) == 0;
    }
    bool load() { return is_whole_ && seccomp_load(filter_.get()) == 0; }

  private:
    std::unique_ptr<void, decltype(&seccomp_release)> filter_;
    bool is_whole_;
};

bool loadFilter() {
    CallFilter filter;
    for (const char* call : kForbidden) filter.refuse(call, EPERM);
    for (const int flag : {O_WRONLY, O_RDWR, O_CREAT, O_TRUNC}) {
        filter.refuse("open", EPERM, SCMP_A1(SCMP_CMP_MASKED_EQ, scmp_datum_t(flag), scmp_datum_t(flag)));
        filter.refuse("openat", EPERM, SCMP_A2(SCMP_CMP_MASKED_EQ, scmp_datum_t(flag), scmp_datum_t(flag)));
    }
    // Their flags lie in memory, where a filter cannot look; the C library then takes the older calls.
    for (const char* call : {"openat2", "clone3"}) filter.refuse(call, ENOSYS);
    filter.refuse("clone", EPERM, SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, 0));
    constexpr scmp_datum_t kInt = 0xffffffff;  // the kernel looks at no more of these arguments
    // What would be typed into the terminal of whoever started this.
    for (const unsigned command : {TIOCSTI, TIOCLINUX})
        filter.refuse("ioctl", EPERM, SCMP_A1(SCMP_CMP_MASKED_EQ, kInt, command));
    // A file may send signals to any process when it has something to read.
    for (const int command : {F_SETOWN, F_SETOWN_EX, F_SETSIG})
        filter.refuse("fcntl", EPERM, SCMP_A1(SCMP_CMP_MASKED_EQ, kInt, scmp_datum_t(command)));
    // This process may end itself, and look at its own limits.
    filter.refuse("tgkill", EPERM, SCMP_A0(SCMP_CMP_NE, scmp_datum_t(getpid())));
    filter.refuse("prlimit64", EPERM, SCMP_A0(SCMP_CMP_NE, 0));
    return filter.load();
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

std::atomic<bool> is_capped = false;

// Returns the limits with `extra_bytes` more than is mapped now; nothing when there is no capping.
std::optional<rlimit> cappedLimit(uint64_t extra_bytes, rlimit& now) {
    uint64_t pages = 0;
    if (kIsSanitized || !(std::ifstream("/proc/self/statm") >> pages) || getrlimit(RLIMIT_AS, &now) != 0)
        return std::nullopt;
    rlimit capped = now;
    capped.rlim_cur = std::min<rlim_t>(now.rlim_cur, pages * uint64_t(sysconf(_SC_PAGESIZE)) + extra_bytes);
    return capped;
}

std::string sizeText(const std::vector<uint64_t>& dims) {
    std::string text;
    for (const uint64_t n : dims) text += (text.empty() ? "" : " x ") + std::to_string(n);
    return text;
}

}  // namespace

void confineReader() {
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 || !dropCapabilities() || !loadFilter())
        throw UserError("this kernel cannot confine the process that reads scans (seccomp)");
}

MemoryCap::MemoryCap(uint64_t extra_bytes) : is_outermost_(!is_capped.exchange(true)) {
    if (!is_outermost_) return;
    const auto capped = cappedLimit(extra_bytes, before_);
    is_set_ = capped && setrlimit(RLIMIT_AS, &*capped) == 0;
}

MemoryCap::~MemoryCap() {
    if (is_set_) setrlimit(RLIMIT_AS, &before_);
    if (is_outermost_) is_capped = false;
}

uint64_t memoryForAll(uint64_t bytes_of_one, uint64_t bytes_taken) {
    constexpr uint64_t kThread = uint64_t(256) << 20;  // its stack and its heap, most of it never used
    return mostAtATime() * (bytes_of_one + kThread) + bytes_taken;
}

void capMemoryForGood(uint64_t extra_bytes) noexcept {
    rlimit now{};
    auto capped = cappedLimit(extra_bytes, now);
    if (!capped) return;
    capped->rlim_max = capped->rlim_cur;
    if (capped->rlim_max < now.rlim_max) noteOwnAddressLimit(capped->rlim_max);
    setrlimit(RLIMIT_AS, &*capped);
}

void checkVolumeSize(const std::vector<uint64_t>& dims, uint64_t bytes_per_voxel, const std::string& file) {
    if (dims.size() != 3)
        throw UserError(file + ": has " + std::to_string(dims.size()) + " dimensions (" + sizeText(dims) +
                        "); one volume of three is needed");
    uint64_t voxels = 1;
    for (const uint64_t n : dims) {
        if (n < 2)
            throw UserError(file + ": is only " + sizeText(dims) +
                            " voxels; a volume needs 2 or more per axis");
        if (n > kMaxVoxels || (voxels *= n) > kMaxVoxels)
            throw UserError(file + ": claims " + sizeText(dims) +
                            " voxels, more than 2^31; crop or resample it");
    }
    // Samples move from the reader's process to this one; what was moved is given back.
    const uint64_t needed = voxels * bytes_per_voxel;
    if (const FreeMemory free = freeMemory(); !free.holds(needed))
        throw UserError(file + ": " + sizeText(dims) + " voxels need " + std::to_string(needed >> 20) +
                        " MiB to import and " + free.text() + "; crop or resample it");
}

void refuseMemory(uint64_t bytes, const std::string& file) {
    const FreeMemory free = freeMemory();
    if (!free.holds(bytes))
        throw UserError(file + ": there is not enough memory to read it: it may take " +
                        std::to_string(bytes >> 20) + " MiB, and " + free.text() + "; crop or resample it");
    throw UserError(file + ": asks for more than " + std::to_string(bytes >> 20) +
                    " MiB of memory, which no file of its size needs; it is damaged");
}

void checkAllCanBeBone(const std::vector<uint64_t>& dims, const std::string& file) {
    uint64_t bricks = 1;
    for (const uint64_t n : dims) bricks *= (n + 2 + kBrickCells - 1) / kBrickCells;
    const uint64_t needed = bricks * kBrickSize * sizeof(uint16_t);
    if (const FreeMemory free = freeMemory(); !free.holds(needed))
        throw UserError(file + ": all of its " + sizeText(dims) + " voxels may need " +
                        std::to_string(needed >> 20) + " MiB as bone and " + free.text() +
                        "; name the part that is milled in volume.region, or crop or resample it");
}

void checkStoredBytes(uint64_t promised_bytes, uint64_t stored_bytes, const std::string& file) {
    if (promised_bytes > stored_bytes)
        throw UserError(file + ": the header promises " + std::to_string(promised_bytes) +
                        " bytes of voxels, the file cannot hold more than " + std::to_string(stored_bytes) +
                        "; it is cut short or damaged");
}

}  // namespace bonemill

// A reader that a file has taken over reads files, tells the process that started it of them, and does
// nothing else: every system call that there is, and what an attacker would do with them, tried from within.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <mqueue.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/ipc.h>
#include <sys/mount.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/sem.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <set>
#include <thread>

#include "haptic_server/scans/confined/guarded_import.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"

namespace bonemill {
namespace {

// What other programs, and the process that starts the reader, have.
struct Surroundings {
    Surroundings() {
        std::ofstream(folder / "there") << "text";
        *static_cast<int*>(shmat(segment, nullptr, 0)) = 30;
        socketpair(AF_UNIX, SOCK_DGRAM, 0, sockets);
    }
    ~Surroundings() {
        shmctl(segment, IPC_RMID, nullptr);
        semctl(semaphore, 0, IPC_RMID);
        close(sockets[0]);
        close(sockets[1]);
    }
    Surroundings(const Surroundings&) = delete;
    Surroundings& operator=(const Surroundings&) = delete;

    const test::TemporaryFolder folder;
    const int segment = shmget(IPC_PRIVATE, 4096, IPC_CREAT | 0600);
    const int semaphore = semget(IPC_PRIVATE, 1, IPC_CREAT | 0600);
    int sockets[2] = {-1, -1};
};

class Attempts {
  public:
    void operator()(const char* what, long result) {
        if (result >= 0) done_ += std::string(what) + " ";
    }
    // For those that would fail here for other reasons, too.
    void expectRefused(const char* what, long result) {
        if (result >= 0 || errno != EPERM) done_ += std::string(what) + " ";
    }
    std::string done() const { return done_; }

  private:
    std::string done_;
};

void attemptFilesAndNetwork(Attempts& attempt, const std::string& folder) {
    const std::string there = folder + "/there";
    attempt("socket", socket(AF_INET, SOCK_DGRAM, 0));
    attempt("local socket", socket(AF_UNIX, SOCK_STREAM, 0));
    attempt("file", open((folder + "/new").c_str(), O_CREAT | O_WRONLY, 0600));
    attempt("nameless file", open(folder.c_str(), O_TMPFILE | O_RDWR, 0600));
    attempt("file in memory", syscall(SYS_memfd_create, "name", 0));
    attempt("change", open(there.c_str(), O_RDWR));
    attempt("emptying", open(there.c_str(), O_RDONLY | O_TRUNC));
    attempt("removal", unlink(there.c_str()));
    attempt("mode", chmod(there.c_str(), 0777));
    constexpr long kChangeModeAt = 452;  // fchmodat2
    attempt("newer mode", syscall(kChangeModeAt, AT_FDCWD, there.c_str(), 0777, 0));
    attempt("mount", mount("none", folder.c_str(), "tmpfs", 0, nullptr));
}

void attemptProcesses(Attempts& attempt) {
    attempt("trace", ptrace(PTRACE_TRACEME, 0, nullptr, nullptr));
    attempt("kill", kill(getppid(), 0));
    char key = 'x';
    attempt.expectRefused("typing", ioctl(STDIN_FILENO, TIOCSTI, &key));
    attempt.expectRefused("console", ioctl(STDIN_FILENO, TIOCLINUX, &key));
    attempt("queued signal", sigqueue(getppid(), 0, {}));
    siginfo_t info{};
    info.si_code = SI_QUEUE;
    attempt("thread's queued signal", syscall(SYS_rt_tgsigqueueinfo, getppid(), getppid(), 0, &info));
    attempt("thread's signal", syscall(SYS_tgkill, getppid(), getppid(), 0));
    rlimit limit{};
    attempt("limits", prlimit(getppid(), RLIMIT_NOFILE, nullptr, &limit));
    cpu_set_t processors;
    sched_getaffinity(0, sizeof processors, &processors);
    attempt("processors", sched_setaffinity(getppid(), sizeof processors, &processors));
    attempt("priority", setpriority(PRIO_PROCESS, id_t(getppid()), 5));
    const sched_param batch{};
    attempt("scheduling", sched_setscheduler(getppid(), SCHED_BATCH, &batch));
    attempt("signals of a file", fcntl(STDIN_FILENO, F_SETOWN, getppid()));
    attempt("process", fork());
    char name[] = "/bin/true";
    char* words[] = {name, nullptr};
    attempt("program", execv(name, words));
}

void attemptIpc(Attempts& attempt, const Surroundings& around) {
    void* const shared = shmat(around.segment, nullptr, 0);
    if (shared != reinterpret_cast<void*>(-1)) {
        *static_cast<int*>(shared) = 300;
        attempt("shared memory", 0);
    }
    attempt("removal of shared memory", shmctl(around.segment, IPC_RMID, nullptr));
    attempt("semaphore", semctl(around.semaphore, 0, SETVAL, 1));
    attempt("message queue", mq_open("/bonemill_confined_reader", O_CREAT | O_RDWR, 0600, nullptr));
    attempt("System V message queue", syscall(SYS_msgget, IPC_PRIVATE, IPC_CREAT | 0600));
    for (const int inherited : around.sockets) {
        attempt("sending", send(inherited, "x", 1, MSG_DONTWAIT));
        attempt("writing", write(inherited, "x", 1));
        attempt("inherited", fcntl(inherited, F_GETFD));
    }
}

std::string doneByReader(const Surroundings& around) {
    Attempts attempt;
    attemptFilesAndNetwork(attempt, around.folder.path());
    attemptProcesses(attempt);
    attemptIpc(attempt, around);
    std::string done = attempt.done();
    char byte;
    if (read(STDIN_FILENO, &byte, 1) != 0) done += "stdin ";
    if (open((around.folder / "there").c_str(), O_RDONLY) < 0) done += "cannot read ";
    std::thread([&done] { done += "thread "; }).join();
    return done;
}

TEST(ConfinedReader, readsFilesAndDoesNothingElse) {
    const Surroundings around;
    const auto read = [&]() -> RawVolume { throw UserError("done: " + doneByReader(around)); };
    expectUserError([&] { importGuarded("file", read); }, {"done: thread "});
    EXPECT_TRUE(std::filesystem::exists(around.folder / "there"));
    const void* const segment = shmat(around.segment, nullptr, SHM_RDONLY);
    ASSERT_NE(segment, reinterpret_cast<void*>(-1)) << "it was removed";
    EXPECT_EQ(*static_cast<const int*>(segment), 30);
    EXPECT_EQ(std::system("true"), 0) << "only the reader is confined";
}

// Ends the process, or jumps.
constexpr const char* kNotTried[] = {"exit", "exit_group", "rt_sigreturn"};

// A call that is refused looks at none of its arguments, and these let no other do harm.
std::string callsThatAreNotRefused() {
    constexpr long kLast = 600;  // there are about 470 in 2025
    std::set<long> not_tried;
    for (const char* name : kNotTried) not_tried.insert(seccomp_syscall_resolve_name(name));
#ifdef __x86_64__
    // uretprobe and uprobe: newer kernels show them to no filter, and answer only where they have put them.
    not_tried.insert({335, 336});
#endif
    std::string names;
    for (long number = 0; number <= kLast; ++number) {
        if (not_tried.count(number) > 0) continue;
        if (syscall(number, -1, -1, -1, -1, -1, -1) < 0 && (errno == EPERM || errno == ENOSYS)) continue;
        const std::unique_ptr<char, decltype(&free)> name(
            seccomp_syscall_resolve_num_arch(SCMP_ARCH_NATIVE, int(number)), free);
        names += (name ? name.get() : std::to_string(number)) + std::string(" ");
    }
    return names;
}

TEST(ConfinedReader, ofAllSystemCallsOnlyThoseThatReadingNeedsAreAnswered) {
    // What may be among them: with such arguments some are refused as well.
    const std::set<std::string> harmless {
        "brk", "mmap", "munmap", "mprotect", "mremap", "madvise", "read", "readv", "pread64", "lseek",
            "close", "poll", "ppoll", "stat", "fstat", "lstat", "newfstatat", "statx", "statfs", "fstatfs",
            "access", "faccessat", "faccessat2", "readlink", "readlinkat", "getcwd", "getdents64",
            "fadvise64", "futex", "rseq", "clone", "sched_yield", "set_robust_list", "rt_sigaction",
            "sched_getaffinity", "sigaltstack", "rt_sigprocmask", "restart_syscall", "clock_gettime",
            "clock_getres", "nanosleep", "gettimeofday", "times", "clock_nanosleep", "getrusage", "sysinfo",
            "uname", "getpid", "getppid", "gettid", "getuid", "geteuid", "getgid", "getegid", "getrandom",
            "time",
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
            "pipe", "pipe2", "write",
#endif
    };
    std::string answered;
    try {
        importGuarded("file", []() -> RawVolume { throw UserError(callsThatAreNotRefused()); });
    } catch (const UserError& error) {
        answered = error.what();
    }
    EXPECT_NE(answered.find("getpid "), std::string::npos) << answered;
    std::istringstream names(answered);
    for (std::string name; names >> name;) EXPECT_EQ(harmless.count(name), 1u) << name;
}

}  // namespace
}  // namespace bonemill

#include "haptic_server/scans/confined/guarded_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <new>
#include <stdexcept>
#include <type_traits>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/confined/confine_reader.h"
#include "haptic_server/scans/confined/free_memory.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/confined/shared_name.h"

namespace bonemill {
namespace {

constexpr rlim_t kMaxCpuSeconds = 600;  // The largest volumes take seconds.

constexpr size_t kMaxErrorBytes = 2048;  // it may quote a damaged header

struct WordsHead {
    uint8_t kind;
    uint64_t bytes;
};
static_assert(std::is_trivially_copyable_v<WordsHead>);

// What the library did is done again, or abort() goes on, and the process ends as it would have without this.
void nameFileAndEnd(int number) {
    nameFileOfEndingThread();
    signal(number, SIG_DFL);
}

void handleSignals() {
    struct sigaction naming {};
    naming.sa_handler = nameFileAndEnd;
    naming.sa_flags = SA_ONSTACK;
    for (const int number : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) sigaction(number, &naming, nullptr);
    for (const int number : {SIGTERM, SIGINT}) signal(number, SIG_DFL);
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_UNBLOCK, &all, nullptr);
}

// A reader without the process that it reads for would only hold on to what it has. That one may have gone
// before this is asked for.
void endWithReaderOf(int pipe) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    pollfd other_end{pipe, 0, 0};
    if (poll(&other_end, 1, 0) > 0 && (other_end.revents & POLLERR) != 0) _exit(1);
}

// Whoever waits for a disk that is gone cannot be ended, so it is not waited for long. Returns how it ended.
int endOf(pid_t child) {
    kill(child, SIGKILL);  // one that has closed the pipe by ending has ended as it did
    constexpr timespec kBetween{0, 1'000'000};
    constexpr int kMaxTries = 10'000;  // a large process takes its time to go
    int status = 0;
    for (int tries = 0; tries < kMaxTries; ++tries) {
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended == child || (ended < 0 && errno != EINTR)) break;
        nanosleep(&kBetween, nullptr);
    }
    return status;
}

// Nothing that a library does with a damaged file kills its process from outside: the kernel does when a
// limit of memory is reached.
std::string whyItEnded(int status) {
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
        return "the process that reads it was killed from outside, as happens where a limit of memory is "
               "reached: " +
               freeMemory().text() + "; give it more, or crop or resample the scan";
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        return printed("its library did not end within %d s of processor time; the file is damaged",
                       int(kMaxCpuSeconds));
    return std::string("the library that reads such files failed on it (") +
           (WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "it ended early") +
           "): the file is damaged, or of a kind that the library cannot read; open it in another program, "
           "such "
           "as 3D Slicer, and export it anew";
}

}  // namespace

bool sendWords(int pipe, uint8_t kind, std::string_view text) {
    WordsHead head{};
    head.kind = kind;
    head.bytes = text.size();
    return writeAll(pipe, &head, sizeof head) && writeAll(pipe, text.data(), text.size());
}

bool receiveWords(Incoming& from, Words& words) {
    WordsHead head;
    if (!from.read(&head, sizeof head)) return false;
    if (head.bytes > kMaxWordsBytes) throw std::length_error("text");
    words.kind = head.kind;
    words.text.assign(head.bytes, '\0');
    if (!from.read(words.text.data(), words.text.size())) return false;
    if (words.kind == kErrorWords) throw UserError(oneLine(words.text.substr(0, kMaxErrorBytes)));
    return true;
}

void sendAsChild(int file, const std::filesystem::path& path, const std::function<void()>& send) {
    handleSignals();
    endWithReaderOf(file);
    const rlimit no_core{0, 0},
        cpu{kMaxCpuSeconds, kMaxCpuSeconds + 1};  // at the hard one it would be SIGKILL
    setrlimit(RLIMIT_CORE, &no_core);
    setrlimit(RLIMIT_CPU, &cpu);
    dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDERR_FILENO);  // the libraries' chatter would stand between the user and the one message
    dup2(nowhere, STDOUT_FILENO);
    const FreeMemory free = freeMemory();
    try {
        if (free.bytes > 0) capMemoryForGood(free.bytes);
        confineReader(file);
        send();
    } catch (const std::bad_alloc&) {
        sendWords(file, kErrorWords,
                  nameOfFileBeingRead(path) + ": there is not enough memory to read it: " + free.text() +
                      "; crop or resample it");
    } catch (const UserError& error) {
        sendWords(file, kErrorWords, error.what());
    } catch (const std::exception& error) {
        sendWords(file, kErrorWords, path.string() + ": cannot be read: " + error.what());
    }
    _exit(0);  // no destructor of the parent's objects may run twice
}

void receiveFrom(const std::filesystem::path& path, const StartReader& start, std::chrono::milliseconds most,
                 const std::function<bool(Incoming&)>& take) {
    const SharedName name;
    Pipe pipe;
    const pid_t child = start(pipe.end(1), name.file());
    if (child < 0) throw UserError("cannot start a process to read " + path.string() + "; memory is short");
    pipe.closeEnd(1);
    Incoming incoming(pipe.end(0), most, [&] {
        spdlog::info("reading {} takes a while; it is at {}", oneLine(path.string()),
                     nameOfFileBeingRead(path));
    });
    std::string error;
    bool is_complete = false;
    try {
        is_complete = take(incoming);
    } catch (const UserError& told) {
        error = told.what();
    } catch (const std::bad_alloc&) {
        error = path.string() + ": there is not enough memory to hold it: " + freeMemory().text() +
                "; crop or resample it";
    } catch (const std::length_error&) {
        error = nameOfFileBeingRead(path) +
                ": what its reader handed over does not fit together; the file is damaged";
    }
    if (incoming.isLate()) {
        kill(child, SIGKILL);
        // Whoever waits for a disk that is gone cannot be ended, so its end is not waited for either.
        waitpid(child, nullptr, WNOHANG);
        throw UserError(nameOfFileBeingRead(path) + ": could not be read within " +
                        printed("%g", std::chrono::duration<double>(most).count()) +
                        " s; is its disk or network slow or gone, or does it lead to a pipe?");
    }
    const int status = endOf(child);
    if (!error.empty()) throw UserError(error);
    if (!is_complete) throw UserError(nameOfFileBeingRead(path) + ": " + whyItEnded(status));
}

StartReader forkOf(const std::function<void(int pipe)>& read) {
    return [read](int pipe, int) {
        std::fflush(nullptr);  // or the child might write what is still buffered a second time
        const pid_t child = fork();
        if (child == 0) read(pipe);
        return child;
    };
}

}  // namespace bonemill

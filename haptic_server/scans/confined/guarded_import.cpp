#include "haptic_server/scans/confined/guarded_import.h"

#include <fcntl.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <new>
#include <span>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/confined/confine_reader.h"
#include "haptic_server/scans/confined/free_memory.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/confined/reader_pipe.h"
#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/labels/labels.h"

namespace bonemill {
namespace {

constexpr rlim_t kMaxCpuSeconds = 600;  // The largest volumes take seconds.

// No enumeration, as no bool: the child may have been made to write anything.
constexpr uint8_t kError = 0, kVolume = 1, kLines = 2;

// This goes through the pipe first; then the text (description, lines or error), the segments, the values.
struct Head {
    uint8_t kind;
    uint8_t is_hounsfield;
    uint8_t lacks_patient_axes;
    int32_t dims[3];
    double spacing[3];
    double position[3];
    double rotation[4];  // Eigen's order
    uint8_t has_surface_value;
    double surface_value;
    uint64_t text_bytes;
    uint64_t segments_bytes;
    uint64_t values;
    uint64_t type;  // RawValues::type()
};
static_assert(std::is_trivially_copyable_v<Head>);

constexpr uint64_t kMaxTextBytes = uint64_t(1) << 20;
constexpr size_t kMaxErrorBytes = 2048;  // it may quote a damaged header

bool isWithin(std::span<const double> numbers, double low, double high) {
    return std::ranges::all_of(numbers, [&](double n) { return n >= low && n <= high; });
}

// A volume's place, as far as any file of ours may say it (physical_frame.h).
bool isPlace(const Head& head) {
    constexpr double kMinStep = 1e-10, kLongestStep = 10, kFarthest = 1e5, kUnit = 1e-9;
    double square = 0;
    for (const double q : head.rotation) square += q * q;
    return isWithin(head.spacing, kMinStep, kLongestStep) && isWithin(head.position, -kFarthest, kFarthest) &&
           std::abs(square - 1) <= kUnit;
}

// The child may have been damaged by what it read, and what it says is checked before memory is asked for.
// Throws std::length_error.
void checkHead(const Head& head, uint8_t wanted) {
    if (head.text_bytes > kMaxTextBytes || head.segments_bytes > kMaxTextBytes)
        throw std::length_error("text");
    if (head.kind != kError && head.kind != wanted) throw std::length_error("kind");
    if (head.kind != kVolume) return;
    uint64_t voxels = 1;
    for (const int32_t n : head.dims) {
        if (n < 1 || (voxels *= uint64_t(n)) > kMaxVoxels) throw std::length_error("dims");
    }
    if (head.values != voxels || head.type >= std::variant_size_v<RawValues::Samples>)
        throw std::length_error("values");
    if (!isPlace(head) || !std::isfinite(head.surface_value)) throw std::length_error("place");
}

constexpr size_t kChunk = size_t(1) << 20;  // values

// Each chunk leaves this process once it is in the pipe, or both would hold the whole scan.
bool sendValues(int file, RawValues& values) {
    for (size_t begin = 0; begin < values.size(); begin += kChunk) {
        const size_t end = std::min(begin + kChunk, values.size());
        const bool is_sent = values.visit([&](auto samples) {
            const auto chunk = samples.subspan(begin, end - begin);
            return writeAll(file, chunk.data(), chunk.size_bytes());
        });
        if (!is_sent) return false;
        values.forget(begin, end);
    }
    return true;
}

template <class T>
bool receiveValues(Incoming& from, size_t count, RawValues& values) {
    std::vector<T> chunk;
    values.reserve(count);
    while (values.size() < count) {
        chunk.resize(std::min(kChunk, count - values.size()));
        if (!from.read(chunk.data(), chunk.size() * sizeof(T))) return false;
        values.append(std::span<const T>(chunk));
    }
    return true;
}

bool receiveValues(Incoming& from, const Head& head, RawValues& values) {
    constexpr bool (*kReceive[])(Incoming&, size_t, RawValues&) = {
        // order of RawValues::Samples
        receiveValues<uint8_t>, receiveValues<int16_t>, receiveValues<uint16_t>, receiveValues<float>};
    static_assert(std::size(kReceive) == std::variant_size_v<RawValues::Samples>);
    return kReceive[head.type](from, head.values, values);
}

void sendVolume(int file, RawVolume raw) {
    Head head{};
    head.kind = kVolume;
    head.is_hounsfield = raw.is_hounsfield;
    head.lacks_patient_axes = raw.lacks_patient_axes;
    std::copy_n(raw.geometry.dims.data(), 3, head.dims);
    std::copy_n(raw.geometry.spacing.data(), 3, head.spacing);
    std::copy_n(raw.geometry.X_WV.position.data(), 3, head.position);
    std::copy_n(raw.geometry.X_WV.rotation.coeffs().data(), 4, head.rotation);
    head.has_surface_value = raw.surface_value.has_value();
    head.surface_value = raw.surface_value.value_or(0);
    const std::string segments = textOfSegments(raw.segments);
    head.text_bytes = raw.description.size();
    head.segments_bytes = segments.size();
    head.values = raw.values.size();
    head.type = raw.values.type();
    writeAll(file, &head, sizeof head) && writeAll(file, raw.description.data(), raw.description.size()) &&
        writeAll(file, segments.data(), segments.size()) && sendValues(file, raw.values);
}

void sendText(int file, uint8_t kind, const std::string& text) {
    Head head{};
    head.kind = kind;
    head.text_bytes = text.size();
    writeAll(file, &head, sizeof head) && writeAll(file, text.data(), text.size());
}

void sendLines(int file, const Lines& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + '\n';
    sendText(file, kLines, text);
}

Lines linesOf(const std::string& text) {
    Lines lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(printable(line));
    return lines;
}

// Of these one is there.
struct Received {
    RawVolume volume;
    Lines lines;
    std::string error;
};

// It is false when the child died, or it was too late, before everything was handed over. Throws
// std::length_error when what comes does not fit together.
bool receive(Incoming& from, uint8_t wanted, Received& received) {
    Head head;
    if (!from.read(&head, sizeof head)) return false;
    checkHead(head, wanted);
    std::string text(head.text_bytes, '\0');
    if (!from.read(text.data(), text.size())) return false;
    if (head.kind == kError) received.error = oneLine(text.substr(0, kMaxErrorBytes));
    if (head.kind == kLines) received.lines = linesOf(text);
    if (head.kind != kVolume) return true;
    RawVolume& raw = received.volume;
    raw.description = oneLine(text);
    text.assign(head.segments_bytes, '\0');
    if (!from.read(text.data(), text.size())) return false;
    raw.segments = segmentsFromText(text);
    raw.is_hounsfield = head.is_hounsfield;
    raw.lacks_patient_axes = head.lacks_patient_axes;
    if (head.has_surface_value) raw.surface_value = head.surface_value;
    raw.geometry.dims = Eigen::Map<const Eigen::Vector3i>(head.dims);
    raw.geometry.spacing = Eigen::Map<const Eigen::Vector3d>(head.spacing);
    raw.geometry.X_WV.position = Eigen::Map<const Eigen::Vector3d>(head.position);
    raw.geometry.X_WV.rotation = Eigen::Quaterniond(head.rotation);
    return receiveValues(from, head, raw.values);
}

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

[[noreturn]] void sendAsChild(int file, const std::filesystem::path& path,
                              const std::function<void()>& send) {
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
        sendText(file, kError,
                 nameOfFileBeingRead(path) + ": there is not enough memory to read it: " + free.text() +
                     "; crop or resample it");
    } catch (const UserError& error) {
        sendText(file, kError, error.what());
    } catch (const std::exception& error) {
        sendText(file, kError, path.string() + ": cannot be read: " + error.what());
    }
    _exit(0);  // no destructor of the parent's objects may run twice
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

Received receiveFrom(const std::filesystem::path& path, const StartReader& start,
                     std::chrono::milliseconds most, uint8_t wanted) {
    const SharedName name;
    Pipe pipe;
    const pid_t child = start(pipe.end(1), name.file());
    if (child < 0) throw UserError("cannot start a process to read " + path.string() + "; memory is short");
    pipe.closeEnd(1);
    Incoming incoming(pipe.end(0), most, [&] {
        spdlog::info("reading {} takes a while; it is at {}", oneLine(path.string()),
                     nameOfFileBeingRead(path));
    });
    Received received;
    std::string& error = received.error;
    bool is_complete = false;
    try {
        is_complete = receive(incoming, wanted, received);
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
    return received;
}

// The child is `read` in a copy of this process.
StartReader forkOf(const std::function<void(int pipe)>& read) {
    return [read](int pipe, int) {
        std::fflush(nullptr);  // or the child might write what is still buffered a second time
        const pid_t child = fork();
        if (child == 0) read(pipe);
        return child;
    };
}

}  // namespace

void readAsChild(int file, const std::filesystem::path& path, const std::function<RawVolume()>& read) {
    sendAsChild(file, path, [&] { sendVolume(file, read()); });
}

void readLinesAsChild(int file, const std::filesystem::path& path, const std::function<Lines()>& read) {
    sendAsChild(file, path, [&] { sendLines(file, read()); });
}

RawVolume importFrom(const std::filesystem::path& path, const StartReader& start,
                     std::chrono::milliseconds most) {
    return receiveFrom(path, start, most, kVolume).volume;
}

Lines linesFrom(const std::filesystem::path& path, const StartReader& start, std::chrono::milliseconds most) {
    return receiveFrom(path, start, most, kLines).lines;
}

RawVolume importGuarded(const std::filesystem::path& path, const std::function<RawVolume()>& read,
                        std::chrono::milliseconds most) {
    return importFrom(path, forkOf([&](int pipe) { readAsChild(pipe, path, read); }), most);
}

Lines linesGuarded(const std::filesystem::path& path, const std::function<Lines()>& read,
                   std::chrono::milliseconds most) {
    return linesFrom(path, forkOf([&](int pipe) { readLinesAsChild(pipe, path, read); }), most);
}

}  // namespace bonemill

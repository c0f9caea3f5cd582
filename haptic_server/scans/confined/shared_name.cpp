#include "haptic_server/scans/confined/shared_name.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <new>

namespace bonemill {
namespace {

constexpr size_t kNameBytes = 4096;

char* file_being_read = nullptr;  // shared with the child
std::atomic<bool> is_ending = false;
thread_local char file_of_thread[kNameBytes];

// A thread whose stack is used up needs another one to say what it was at. A thread that has one keeps it,
// and nothing else takes this one away when the thread ends.
class HandlersStack {
  public:
    HandlersStack() {
        stack_t now{};
        if (sigaltstack(nullptr, &now) != 0 || (now.ss_flags & SS_DISABLE) == 0) return;
        memory_.reset(new (std::nothrow) char[kBytes]);
        if (!memory_) return;
        const stack_t handlers{.ss_sp = memory_.get(), .ss_flags = 0, .ss_size = kBytes};
        sigaltstack(&handlers, nullptr);
    }
    ~HandlersStack() {
        const stack_t none{.ss_sp = nullptr, .ss_flags = SS_DISABLE, .ss_size = 0};
        if (memory_) sigaltstack(&none, nullptr);
    }
    HandlersStack(const HandlersStack&) = delete;
    HandlersStack& operator=(const HandlersStack&) = delete;

  private:
    static constexpr size_t kBytes = 64 << 10;
    std::unique_ptr<char[]> memory_;
};

void mapName(int file) {
    void* page = mmap(nullptr, kNameBytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (page != MAP_FAILED) file_being_read = static_cast<char*>(page);
}

// Whoever shrinks memory that another process has mapped ends that process when it looks there.
bool sealSize(int file) {
    return fcntl(file, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) == 0;
}

}  // namespace

SharedName::SharedName() : file_(memfd_create("file_being_read", MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
    if (file_ < 0) return;
    if (ftruncate(file_, kNameBytes) == 0 && sealSize(file_)) {
        mapName(file_);
        return;
    }
    close(file_);
    file_ = -1;
}

SharedName::~SharedName() {
    if (file_being_read) munmap(file_being_read, kNameBytes);
    file_being_read = nullptr;
    if (file_ >= 0) close(file_);
}

std::string nameOfFileBeingRead(const std::filesystem::path& path) {
    const size_t length = file_being_read ? strnlen(file_being_read, kNameBytes) : 0;
    return oneLine(length > 0 ? std::string(file_being_read, length) : path.string());
}

void shareNameOfFileBeingRead(int file) {
    mapName(file);
}

void noteFileBeingRead(const std::filesystem::path& file) noexcept {
    if (!file_being_read) return;
    thread_local HandlersStack stack;
    std::strncpy(file_of_thread, file.c_str(), kNameBytes - 1);
    if (!is_ending) std::memcpy(file_being_read, file_of_thread, kNameBytes);
}

void nameFileOfEndingThread() noexcept {
    is_ending = true;
    if (file_being_read && file_of_thread[0] != 0) std::memcpy(file_being_read, file_of_thread, kNameBytes);
}

std::string oneLine(std::string text) {
    for (size_t n = 0; n < text.size(); ++n) {
        const auto c = static_cast<unsigned char>(text[n]);
        const unsigned char next = n + 1 < text.size() ? static_cast<unsigned char>(text[n + 1]) : 0;
        const bool is_control = c < ' ' || c == 0x7f;
        const bool is_late_control = c == 0xc2 && next >= 0x80 && next < 0xa0;  // U+0080 to U+009F in UTF-8
        if (is_control || is_late_control) text[n] = ' ';
        if (is_late_control) text[n + 1] = ' ';
    }
    return text;
}

}  // namespace bonemill

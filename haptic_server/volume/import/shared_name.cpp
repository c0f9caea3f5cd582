#include "haptic_server/volume/import/shared_name.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "haptic_server/volume/import/file_being_read.h"

namespace bonemill {
namespace {

constexpr size_t kNameBytes = 4096;

char* file_being_read = nullptr;  // shared with the child

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
    if (file_being_read) std::strncpy(file_being_read, file.c_str(), kNameBytes - 1);
}

std::string oneLine(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
    return text;
}

}  // namespace bonemill

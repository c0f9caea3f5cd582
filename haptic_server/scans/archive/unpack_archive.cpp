#include "haptic_server/scans/archive/unpack_archive.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/archive/archive_words.h"
#include "haptic_server/scans/archive/scan_endings.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxNameBytes = 1024;

bool isZip(const fs::path& path) {
    char head[4] = {};
    std::ifstream(path, std::ios::binary).read(head, sizeof head);
    return std::string_view(head, sizeof head) == std::string_view("PK\3\4", 4);
}

bool leadsOut(const fs::path& name) {
    return name.empty() || name.is_absolute() || !name.has_filename() ||
           std::ranges::find(name, fs::path("..")) != name.end();
}

// macOS adds a folder, and everywhere hidden files beside those of its user.
bool isAdded(const fs::path& name) {
    return std::ranges::any_of(name, [](const fs::path& part) {
        return part == "__MACOSX" || (part != "." && part.string().starts_with('.'));
    });
}

// Writes what comes, file after file.
class UnpackedFiles {
  public:
    UnpackedFiles(const fs::path& archive, const fs::path& folder, const ArchiveLimits& limits)
        : archive_(archive.string()), folder_(folder), limits_(limits) {}
    ~UnpackedFiles() { closeFile(); }
    UnpackedFiles(const UnpackedFiles&) = delete;
    UnpackedFiles& operator=(const UnpackedFiles&) = delete;

    void begin(const std::string& name) {
        closeFile();
        const std::string shown = printable(name.substr(0, kMaxNameBytes));
        if (name.size() > kMaxNameBytes || name.find('\0') != std::string::npos || leadsOut(name))
            refuse("holds a file whose name leads out of its folder (" + shown +
                   "); it is damaged, or made to do harm");
        if (++files_ > limits_.files)
            refuse(printed("holds more than %zu files; unpack it, and give the folder of the scan",
                           limits_.files));
        if (isAdded(name)) return;
        const fs::path path = folder_ / fs::path(name).lexically_normal();
        std::error_code error;
        fs::create_directories(path.parent_path(), error);
        file_ = error ? -1 : open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
        if (file_ < 0 && (error || errno == EEXIST || errno == EISDIR))
            refuse("holds two files of one name (" + shown + "); unpack it, and give the folder");
        if (file_ < 0) cannotWrite();
    }
    void add(const std::string& bytes) {
        if (files_ == 0) throw std::length_error("bytes");
        bytes_ += bytes.size();
        if (bytes_ > limits_.bytes)
            refuse(
                printed("unpacks to more than %.4g GiB; if you trust it, unpack it, and give the folder of "
                        "the scan",
                        double(limits_.bytes) / double(uint64_t(1) << 30)));
        if (file_ >= 0 && !writeAll(file_, bytes.data(), bytes.size())) cannotWrite();
    }
    void end() {
        closeFile();
        if (files_ == 0) refuse("holds no files");
    }

  private:
    [[noreturn]] void refuse(const std::string& why) const { throw UserError(archive_ + ": " + why); }
    [[noreturn]] void cannotWrite() const {
        refuse("cannot be unpacked in " + folder_.parent_path().string() + " (" + std::strerror(errno) +
               "); TMPDIR names another folder");
    }
    void closeFile() {
        if (file_ >= 0) close(file_);
        file_ = -1;
    }

    std::string archive_;
    fs::path folder_;
    ArchiveLimits limits_;
    int file_ = -1;
    size_t files_ = 0;
    uint64_t bytes_ = 0;
};

bool takeFiles(Incoming& from, UnpackedFiles& files) {
    for (Words words; receiveWords(from, words);) {
        if (words.kind == kEndWords) {
            files.end();
            return true;
        }
        if (words.kind == kFileWords)
            files.begin(words.text);
        else if (words.kind == kBytesWords)
            files.add(words.text);
        else
            throw std::length_error("kind");
    }
    return false;
}

}  // namespace

bool isArchive(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return false;  // nobody writes into a pipe
    return endsLike(path, kArchiveEndings) || isZip(path);
}

void unpackArchive(const fs::path& path, const fs::path& folder, const StartReader& start,
                   const ArchiveLimits& limits) {
    UnpackedFiles files(path, folder, limits);
    receiveFrom(path, start, kMaxImportTime, [&](Incoming& from) { return takeFiles(from, files); });
}

}  // namespace bonemill

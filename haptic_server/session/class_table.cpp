#include "haptic_server/session/class_table.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "common/lesson/attempts_csv.h"
#include "common/user_error.h"
#include "haptic_server/record/bone_files.h"

namespace bonemill {
namespace {

constexpr int kLockTries = 100;
constexpr int kLockPauseUs = 20'000;

// The open file, for one writer at a time.
class TableFile {
  public:
    explicit TableFile(const std::string& path)
        : path_(path), file_(open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC, 0600)) {
        if (file_ < 0) fail(std::strerror(errno));
        struct stat status {};
        if (fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) {
            close(file_);
            refuse("is no file");
        }
        lock();
    }
    ~TableFile() {
        if (file_ >= 0) close(file_);
    }
    TableFile(const TableFile&) = delete;
    TableFile& operator=(const TableFile&) = delete;

    off_t size() const { return lseek(file_, 0, SEEK_END); }
    std::string read(off_t from, size_t count) const {
        std::string text(count, '\0');
        const ssize_t got = pread(file_, text.data(), count, from);
        text.resize(size_t(got > 0 ? got : 0));
        return text;
    }
    // All of it, or the file stays as it is.
    void append(const std::string& text) const {
        const off_t before = size();
        size_t done = 0;
        while (done < text.size()) {
            const ssize_t got = write(file_, text.data() + done, text.size() - done);
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) undo(before, got < 0 ? errno : ENOSPC);
            done += size_t(got);
        }
        if (fsync(file_) != 0) undo(before, errno);
    }
    void requireTable() const {
        const std::string header = std::string(kAttemptsHeader) + "\n";
        if (size() > 0 && read(0, header.size()) != header)
            refuse("is there and has other columns than a class table; name another file");
    }

  private:
    // Another server may write, and another program may hold the file as long as it likes.
    void lock() {
        for (int tries = 0; flock(file_, LOCK_EX | LOCK_NB) != 0; ++tries) {
            if (tries < kLockTries) {
                usleep(kLockPauseUs);
                continue;
            }
            close(file_);
            fail("another program keeps it locked");
        }
    }
    [[noreturn]] void undo(off_t size, int error) const {
        const bool is_undone = ftruncate(file_, size) == 0;
        fail(std::string(std::strerror(error)) + (is_undone ? "" : "; its last line is not whole"));
    }
    [[noreturn]] void refuse(const std::string& why) const {
        throw UserError("--class-table " + path_ + ": " + why);
    }
    [[noreturn]] void fail(const std::string& why) const {
        throw UserError(path_ + ": cannot be written: " + why);
    }

    std::string path_;
    int file_;
};

}  // namespace

ClassTable::ClassTable(std::string path) : path_(std::move(path)) {
    if (path_.empty()) return;
    try {
        if (!std::filesystem::exists(path_)) {
            requireWritable(path_);
            return;
        }
        TableFile(path_).requireTable();
    } catch (const UserError& error) {
        const std::string text = error.what();
        throw UserError(text.rfind("--class-table", 0) == 0 ? text : "--class-table " + text);
    }
}

std::string ClassTable::append(const topics::Attempt& attempt, const std::string& scene) const {
    if (path_.empty()) return "";
    try {
        const TableFile file(path_);
        file.requireTable();
        const off_t size = file.size();
        std::string text;
        if (size == 0) text = std::string(kAttemptsHeader) + "\n";
        if (size > 0 && file.read(size - 1, 1) != "\n") text = "\n";  // somebody's last line has no end
        file.append(text + attemptLine(attempt, scene) + "\n");
        return "";
    } catch (const std::exception& error) {
        return error.what();
    }
}

}  // namespace bonemill

// A file to which several programs add lines: each line is whole or not there, whatever happens. It is not
// RT-safe.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/user_error.h"
#include "common/files/whole_file.h"

namespace bonemill {

// The file, open for one program at a time: others wait as long as this object lives.
class LineFile {
  public:
    // Makes it, for its user alone, if it is not there. Throws UserError, also when another program keeps it
    // locked for more than kLongestWait_s.
    explicit LineFile(std::filesystem::path path) : path_(std::move(path)) {
        // Another process may have put another file in its place while this one waited for the lock.
        do {
            if (file_ >= 0) close(file_);
            openFile();
            lock();
        } while (!isInItsPlace());
    }
    ~LineFile() {
        if (file_ >= 0) close(file_);
    }
    LineFile(const LineFile&) = delete;
    LineFile& operator=(const LineFile&) = delete;

    static constexpr int kLongestWait_s = 2;

    off_t size() const { return lseek(file_, 0, SEEK_END); }
    std::string read(off_t from, size_t count) const {
        std::string text(count, '\0');
        const ssize_t got = pread(file_, text.data(), count, from);
        text.resize(size_t(got > 0 ? got : 0));
        return text;
    }
    // All of it is on the disk then, or the file stays as it is and this throws UserError. A last line
    // without an end gets one first.
    void append(std::string_view lines) const {
        const off_t before = size();
        std::string text(lines);
        if (before > 0 && read(before - 1, 1) != "\n") text = "\n" + text;
        size_t done = 0;
        while (done < text.size()) {
            const ssize_t got = ::write(file_, text.data() + done, text.size() - done);
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) undo(before, got < 0 ? errno : ENOSPC);
            done += size_t(got);
        }
        if (fsync(file_) != 0) undo(before, errno);
    }
    // Another content takes its place, whole or not at all. Nothing more can be done with this object then.
    void replace(std::string_view content) const { writePrivateFile(path_, content); }
    // Takes all lines out for which is_out(line, is_first) holds, as replace() does, and returns how many;
    // with none the file stays as it is.
    template <class IsOut>
    size_t removeLines(const IsOut& is_out) const {
        const std::string text = read(0, size_t(size()));
        std::string kept;
        size_t removed = 0;
        for (size_t at = 0; at < text.size();) {
            const size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
            const std::string line = text.substr(at, end - at);
            if (is_out(line, at == 0))
                ++removed;
            else
                kept += line;
            at = end;
        }
        if (removed > 0) replace(kept);
        return removed;
    }

  private:
    static constexpr int kLockPauseUs = 20'000;
    static constexpr int kLockTries = kLongestWait_s * 1'000'000 / kLockPauseUs;

    void openFile() {
        file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW, 0600);
        if (file_ < 0) fail(std::strerror(errno));
        struct stat status {};
        if (fstat(file_, &status) == 0 && S_ISREG(status.st_mode)) return;
        close(file_);
        throw UserError(path_.string() + ": is no file");
    }
    void lock() const {
        for (int tries = 0; flock(file_, LOCK_EX | LOCK_NB) != 0; ++tries) {
            if (tries < kLockTries) {
                usleep(kLockPauseUs);
                continue;
            }
            close(file_);
            fail("another program keeps it locked");
        }
    }
    bool isInItsPlace() const {
        struct stat opened {
        }, named{};
        return fstat(file_, &opened) == 0 && stat(path_.c_str(), &named) == 0 &&
               opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
    }
    [[noreturn]] void undo(off_t size, int error) const {
        const bool is_undone = ftruncate(file_, size) == 0;
        fail(std::string(std::strerror(error)) + (is_undone ? "" : "; its last line is not whole"));
    }
    [[noreturn]] void fail(const std::string& why) const {
        throw UserError(path_.string() + ": cannot be written: " + why);
    }

    std::filesystem::path path_;
    int file_ = -1;
};

}  // namespace bonemill

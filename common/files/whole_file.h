// A result that is whole or not there, also after a power cut: it is written beside its place, as
// ".part_NAME", and takes the place of the file of before when it is on the disk. Links and devices are
// written to where they lead. It is not RT-safe.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "common/base/user_error.h"

namespace bonemill {

// Waits until the file, or the entries of the folder, are on the disk. False, with errno: they may not be.
inline bool syncToDisk(const std::filesystem::path& path) {
    const int opened = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (opened < 0) return false;
    // Some file systems cannot be told to, and say so.
    const bool is_there = fsync(opened) == 0 || errno == EINVAL || errno == ENOTSUP;
    const int why = errno;
    close(opened);
    errno = why;
    return is_there;
}

class WholeFile {
  public:
    // Makes the empty file to write to; what an earlier run left half written goes. Who may read it is
    // `mode`, less the umask. Throws UserError.
    explicit WholeFile(const std::filesystem::path& path, mode_t mode = 0666) : path_(path), part_(path) {
        std::error_code error;
        const std::filesystem::file_status status = std::filesystem::symlink_status(path, error);
        is_beside_ = !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
        if (!is_beside_) return;
        part_.replace_filename(".part_" + path.filename().string());
        unlink(part_.c_str());
        // A file or link of that name that belongs to another user is not written to.
        const int file = open(part_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
        if (file < 0)
            throw UserError(path.string() + ": cannot be written (" + part_.filename().string() + ": " +
                            std::strerror(errno) + "); check that its folder exists and is yours");
        close(file);
    }
    ~WholeFile() {
        if (is_beside_ && !is_finished_) unlink(part_.c_str());
    }
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    // The content is to be written there, and closed, before finish().
    std::string part() const { return part_.string(); }

    // Throws std::filesystem::filesystem_error; what was there before stays then. Once the file has taken
    // its place, a folder that cannot be synced is no failure.
    void finish() {
        if (is_beside_) takeItsPlace();
        is_finished_ = true;
    }

  private:
    void takeItsPlace() const {
        if (!syncToDisk(part_))
            throw std::filesystem::filesystem_error("cannot be brought to the disk", path_,
                                                    std::error_code(errno, std::generic_category()));
        std::filesystem::rename(part_, path_);
        const std::filesystem::path folder = path_.parent_path();
        syncToDisk(folder.empty() ? "." : folder);
    }

    std::filesystem::path path_, part_;
    bool is_beside_ = false;
    bool is_finished_ = false;
};

// A file with secrets: readable for its user alone, and whole or not there. Makes its folders, too, where
// there are none. Throws UserError; what was there before stays then.
inline void writePrivateFile(const std::filesystem::path& path, std::string_view content) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);  // the opening says what is wrong
    WholeFile file(path, S_IRUSR | S_IWUSR);
    const int opened = open(file.part().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, S_IRUSR | S_IWUSR);
    bool is_written = opened >= 0 && fchmod(opened, S_IRUSR | S_IWUSR) == 0;
    while (is_written && !content.empty()) {
        const ssize_t count = ::write(opened, content.data(), content.size());
        is_written = count > 0;
        if (is_written) content.remove_prefix(size_t(count));
    }
    if (opened >= 0) is_written = close(opened) == 0 && is_written;
    if (!is_written) throw UserError(path.string() + ": cannot be written: " + std::strerror(errno));
    try {
        file.finish();
    } catch (const std::filesystem::filesystem_error& error) {
        throw UserError(path.string() + ": cannot be written: " + error.code().message());
    }
}

}  // namespace bonemill

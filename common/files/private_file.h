// Files with secrets: readable for their user alone, and whole or not there. It is not RT-safe.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "common/base/user_error.h"
#include "common/files/whole_file.h"

namespace bonemill {

// Makes its folders, too, where there are none. Throws UserError; what was there before stays then.
inline void writePrivateFile(const std::filesystem::path& path, std::string_view content) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);  // the opening says what is wrong
    WholeFile file(path, S_IRUSR | S_IWUSR);
    const int opened = open(file.part().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, S_IRUSR | S_IWUSR);
    bool is_written = opened >= 0 && fchmod(opened, S_IRUSR | S_IWUSR) == 0;
    while (is_written && !content.empty()) {
        const ssize_t count = write(opened, content.data(), content.size());
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

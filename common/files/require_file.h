// Refuses what is no file, before it is opened: opening a named pipe waits for whoever writes into it, and a
// device may never end. It is for start-up only.
#pragma once

#include <filesystem>

#include "common/base/user_error.h"

namespace bonemill {

// What is not there and what is a folder pass: the reader has better words for them. Throws UserError.
inline void requireFile(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status) ||
        std::filesystem::is_directory(status))
        return;
    throw UserError(path.string() + ": is a named pipe, a socket or a device; name a file");
}

// Refuses what would let a writer wait for whoever reads it. Devices pass: they take what is written, or say
// that they are full. Throws UserError.
inline void requireNoPipe(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (std::filesystem::is_fifo(status) || std::filesystem::is_socket(status))
        throw UserError(path.string() + ": is a named pipe or a socket; name a file");
}

}  // namespace bonemill

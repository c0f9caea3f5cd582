// Whether a file is another one than before, without reading it. Not RT-safe.
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <string>

namespace bonemill {

// Another text for a file that was replaced or written since; empty where there is none.
inline std::string stampOf(const std::filesystem::path& file) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0) return "";
    return std::to_string(status.st_ino) + ' ' + std::to_string(status.st_size) + ' ' +
           std::to_string(status.st_mtim.tv_sec) + ' ' + std::to_string(status.st_mtim.tv_nsec);
}

}  // namespace bonemill

// Refuses secrets, and folders of secrets, that others on this PC can read or write. It is for start-up only.
#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include "common/base/user_error.h"

namespace bonemill {

// Who can read a key can be its owner, and who can write it, or into its folder, can make this user somebody
// else. `mode` is what to type, as "600". Throws UserError.
inline void requirePrivate(const std::filesystem::path& path, const std::string& mode) {
    struct stat status {};
    const std::string place = path.string();
    if (stat(place.c_str(), &status) != 0) throw UserError(place + ": " + std::strerror(errno));
    const bool is_own = status.st_uid == geteuid() || status.st_uid == 0 || geteuid() == 0;
    if (!is_own)
        throw UserError(place + " belongs to another user, who can read and change it; copy it, and type: " +
                        "chmod " + mode + " on the copy");
    if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
        throw UserError(place + " can be read or written by others; type: chmod " + mode + " " + place +
                        " (a disk that keeps no permissions, as a stick, is no place for it)");
}

}  // namespace bonemill

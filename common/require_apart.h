// Refuses a run that would write over what it reads, or write two results into one file. It is for start-up
// only.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/user_error.h"

namespace bonemill {

struct NamedFile {
    std::string name;            // what the user knows it by: an option, a field of the scene
    std::filesystem::path path;  // empty: there is none
};

// Whatever links lead there. Devices take what is written one after the other: they are never the same file.
inline bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    namespace fs = std::filesystem;
    std::error_code error;
    if (fs::exists(a, error) && fs::exists(b, error))
        return fs::is_regular_file(a, error) && fs::equivalent(a, b, error);
    const fs::path place = fs::weakly_canonical(fs::absolute(a, error), error);
    return !place.empty() && place == fs::weakly_canonical(fs::absolute(b, error), error);
}

// Throws UserError if one of `written` is the same file as another one of them or as one of `read`.
inline void requireApart(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
    const auto check = [](const NamedFile& file, const NamedFile& other, const char* what) {
        if (!file.path.empty() && !other.path.empty() && isSameFile(file.path, other.path))
            throw UserError(file.name + " " + file.path.string() + ": is the same file as " + other.name +
                            " " + other.path.string() + what + "; name another file to write");
    };
    for (size_t n = 0; n < written.size(); ++n) {
        for (const NamedFile& other : read) check(written[n], other, ", which is read");
        for (size_t k = 0; k < n; ++k) check(written[n], written[k], ", which is written, too");
    }
}

}  // namespace bonemill

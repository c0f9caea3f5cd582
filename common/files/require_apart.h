// Refuses a run that would write over what it reads, or write two results into one file. It is for start-up
// only.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/user_error.h"

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

// Whatever links lead there: the file, also one that is not there yet, lies somewhere in the folder, or is
// one of its files by another name.
inline bool isWithinFolder(const std::filesystem::path& file, const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    if (!fs::is_directory(folder, error) || (fs::exists(file, error) && !fs::is_regular_file(file, error)))
        return false;
    const fs::path inner = fs::weakly_canonical(fs::absolute(file, error), error);
    const fs::path outer = fs::canonical(folder, error);
    if (inner.empty() || outer.empty()) return false;
    if (std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end())
        return true;
    if (const auto links = fs::hard_link_count(inner, error); error || links < 2) return false;
    for (fs::recursive_directory_iterator entry(outer, error), end; !error && entry != end;
         entry.increment(error))
        if (entry->is_regular_file(error) && fs::equivalent(inner, entry->path(), error)) return true;
    return false;
}

// Throws UserError if one of `written` is the same file as another one of them or as one of `read`, or lies
// in a folder that is read.
inline void requireApart(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
    const auto check = [](const NamedFile& file, const NamedFile& other, const char* what) {
        if (file.path.empty() || other.path.empty()) return;
        const auto refuse = [&](const char* how, const char* todo) {
            throw UserError(file.name + " " + file.path.string() + ": " + how + " " + other.name + " " +
                            other.path.string() + what + "; " + todo);
        };
        if (isSameFile(file.path, other.path)) refuse("is the same file as", "name another file to write");
        if (isWithinFolder(file.path, other.path))
            refuse("lies in the folder", "name a file somewhere else to write");
    };
    for (size_t n = 0; n < written.size(); ++n) {
        for (const NamedFile& other : read) check(written[n], other, ", which is read");
        for (size_t k = 0; k < n; ++k) check(written[n], written[k], ", which is written, too");
    }
}

}  // namespace bonemill

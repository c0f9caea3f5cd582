#include "device_daemon/bridges/bridge/shared_library.h"

#include <dlfcn.h>

#include <algorithm>

#include "common/base/user_error.h"

namespace bonemill::bridge {
namespace {

// A folder may have the library under its name or, as unpacked archives do, only with all of its version:
// then the newest name counts.
std::filesystem::path fileIn(const std::filesystem::path& folder, const std::string& file) {
    std::error_code error;
    if (exists(folder / file, error)) return folder / file;
    std::filesystem::path found;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (entry.path().filename().string().starts_with(file + ".")) found = std::max(found, entry.path());
    return found;
}

std::filesystem::path searched(const LibrarySearch& search) {
    if (!search.chosen.empty()) return search.chosen;
    for (const std::filesystem::path& folder : search.folders)
        if (std::filesystem::path found = fileIn(folder, search.file); !found.empty()) return found;
    return search.file;
}

std::string placesOf(const LibrarySearch& search) {
    std::vector<std::string> places;
    for (const std::filesystem::path& folder : search.folders) places.push_back(folder.string());
    places.push_back("the dynamic linker's own folders (LD_LIBRARY_PATH, ldconfig)");
    return joined(places);
}

bool isMissing(const LibrarySearch& search, const std::filesystem::path& path, const std::string& reason) {
    std::error_code error;
    if (path.has_parent_path()) return !exists(path, error);
    return reason.starts_with(search.file + ":");  // the linker names the file that it does not find
}

[[noreturn]] void refuse(const LibrarySearch& search, const std::filesystem::path& path,
                         const std::string& reason) {
    if (!isMissing(search, path, reason))
        throw UserError("dependency: " + path.string() + " is there and cannot be loaded: " + reason +
                        ". Install what it needs (ldd " + path.string() + " lists it).");
    if (!search.chosen.empty())
        throw UserError("library: " + search.chosen + " does not exist (--library names " + search.file +
                        " of " + search.product + ")");
    throw UserError("library: " + search.file + " was not found in " + placesOf(search) + ". Install " +
                    search.product + ", or name the file with --library.");
}

}  // namespace

SharedLibrary::SharedLibrary(const LibrarySearch& search) {
    const std::filesystem::path path = searched(search);
    path_ = path.string();
    handle_ = dlopen(path_.c_str(), RTLD_LAZY | (search.is_global ? RTLD_GLOBAL : RTLD_LOCAL));
    if (handle_) return;
    const char* reason = dlerror();
    refuse(search, path, reason ? reason : "no reason given");
}

void* SharedLibrary::find(const char* name, std::vector<std::string>& missing) {
    void* const symbol = dlsym(handle_, name);
    if (!symbol) missing.push_back(name);
    return symbol;
}

void SharedLibrary::checkRequired() const {
    if (missing_.empty()) return;
    throw UserError("library: " + path_ + " lacks " + joined(missing_) +
                    ". It is another library, or a version that this bridge does not know.");
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

}  // namespace bonemill::bridge

// Loads a vendor's library at run time, and says what is wrong in words that tell one reason from another.
//
// It is for start-up only. The library stays loaded until the process ends: drivers that are unloaded while
// their threads run crash, and some fail when they are loaded again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace bonemill::bridge {

struct LibrarySearch {
    std::string file;                                 // "libdrd.so.3", as the dynamic linker finds it
    std::string product;                              // whose it is, for people: "the Force Dimension SDK"
    std::string chosen;                               // --library: this file and no other; empty: search
    bool is_global = false;                           // its symbols serve the libraries that it loads itself
    std::vector<std::filesystem::path> folders = {};  // that are searched before the dynamic linker's own
};

class SharedLibrary {
  public:
    // Throws UserError: the library is nowhere (and where that was), or it is there and cannot be loaded (and
    // the dynamic linker's own words).
    explicit SharedLibrary(const LibrarySearch& search);

    const std::string& path() const { return path_; }

    // Looks a function up; one that is not there becomes a null pointer, and its name is remembered.
    template <class Function>
    void require(Function*& function, const char* name) {
        function = reinterpret_cast<Function*>(find(name, missing_));
    }
    template <class Function>
    void allow(Function*& function, const char* name) {
        function = reinterpret_cast<Function*>(find(name, missing_optional_));
    }
    const std::vector<std::string>& missingOptional() const { return missing_optional_; }
    // Throws UserError if a required function is missing.
    void checkRequired() const;

  private:
    void* find(const char* name, std::vector<std::string>& missing);

    std::string path_;
    void* handle_ = nullptr;
    std::vector<std::string> missing_;
    std::vector<std::string> missing_optional_;
};

// Returns "a, b, c".
std::string joined(const std::vector<std::string>& words);

}  // namespace bonemill::bridge

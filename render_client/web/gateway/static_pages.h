// The page's files, in memory: what is not one of them is not there. Any thread after construction.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

namespace bonemill::gateway {

struct StaticFile {
    std::string bytes;
    std::string gzip;  // the same, compressed; empty: there is none
    const char* type = "";
    bool is_index = false;
};

class StaticPages {
  public:
    static constexpr size_t kMaxFiles = 256, kMaxBytes = 64 << 20;

    // Reads a folder; one that is not there leaves a page that says so. Throws UserError where it is too
    // large.
    explicit StaticPages(const std::filesystem::path& folder);
    // `path` is that of an address: "/", "/main.js". Returns nothing for what is not there.
    const StaticFile* find(const std::string& path) const;
    bool isBuilt() const noexcept { return is_built_; }

  private:
    std::map<std::string, StaticFile> files_;  // by path
    bool is_built_ = false;
};

}  // namespace bonemill::gateway

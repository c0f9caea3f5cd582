// Where a user's own settings lie. For any thread; not RT-safe.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace bonemill {

// Returns $XDG_CONFIG_HOME/bonemill, or ~/.config/bonemill.
inline std::filesystem::path configFolder() {
    const char* const config = std::getenv("XDG_CONFIG_HOME");
    if (config && *config) return std::filesystem::path(config) / "bonemill";
    const char* const home = std::getenv("HOME");
    return std::filesystem::path(home ? home : ".") / ".config" / "bonemill";
}

}  // namespace bonemill

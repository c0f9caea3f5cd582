// The folder of --secure: what proves to the others of a session who this program is
// (docs/howto/security.md). It is not for the tick.
#pragma once

#include <ctime>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/security/certificate.h"

namespace bonemill {

class SecurityFolder {
  public:
    // Checks that everything is there, belongs together, is valid at that unix time and out of others' reach
    // on this PC, for Cyclone DDS's own messages say little. Throws UserError.
    explicit SecurityFolder(const std::filesystem::path& folder, std::time_t now = std::time(nullptr));

    const Identity& self() const noexcept { return self_; }
    const std::filesystem::path& folder() const noexcept { return folder_; }
    // Returns the properties of a participant that turn DDS Security on, with these plugins
    // (pluginFolder()).
    std::vector<std::pair<std::string, std::string>> properties(const std::filesystem::path& plugins) const;

  private:
    std::filesystem::path folder_;
    Identity self_;
};

// Returns where the plugins of Cyclone DDS lie, whose library is in that folder. Throws UserError when they
// are missing.
std::filesystem::path pluginFolder(const std::filesystem::path& of_library);

}  // namespace bonemill

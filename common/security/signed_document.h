// What a certificate authority has signed: the rules of a session and what a person may write and read
// (.p7s). It is not for the tick.
#pragma once

#include <ctime>
#include <filesystem>
#include <string>

#include "common/security/certificate.h"

namespace bonemill {

// Returns the text. Throws UserError when the file cannot be read, or this authority has not signed it.
std::string signedText(const std::filesystem::path& file, const Certificate& authority);

// Throws UserError unless the permissions are for this certificate's owner, and valid at that unix time. The
// rest of them is DDS Security's business.
void requirePermissionsFor(const std::string& text, const Certificate& owner, std::time_t now);

}  // namespace bonemill

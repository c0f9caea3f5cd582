// The gateway's certificate: the user's, or one of its own making that is kept and used again. For start-up.
#pragma once

#include <ctime>
#include <filesystem>
#include <string>

namespace bonemill::gateway {

struct GatewayCertificate {
    std::filesystem::path certificate;  // PEM
    std::filesystem::path key;          // PEM
    std::string fingerprint;            // SHA-256 of the certificate's DER, 64 hexadecimal digits
    bool is_self_made = false;
};

// Throws UserError for files that are no certificate and its key, and for one that is not valid at that unix
// time.
GatewayCertificate certificateOf(const std::filesystem::path& certificate, const std::filesystem::path& key,
                                 std::time_t now = std::time(nullptr));
// Returns the one in this folder, which is made (EC P-256, ten years) where there is none. The key is
// readable for the user alone. Throws UserError, likewise.
GatewayCertificate selfMadeCertificate(const std::filesystem::path& folder,
                                       std::time_t now = std::time(nullptr));

}  // namespace bonemill::gateway

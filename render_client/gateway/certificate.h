// The gateway's certificate: the user's, or one of its own making that is kept and used again. For start-up.
#pragma once

#include <filesystem>
#include <string>

namespace bonemill::gateway {

struct Certificate {
    std::filesystem::path certificate;  // PEM
    std::filesystem::path key;          // PEM
    std::string fingerprint;            // SHA-256 of the certificate's DER, 64 hexadecimal digits
    bool is_self_made = false;
};

// Throws UserError for files that are no certificate.
Certificate certificateOf(const std::filesystem::path& certificate, const std::filesystem::path& key);
// Returns the one in this folder, which is made (EC P-256, ten years) where there is none. The key is
// readable for the user alone. Throws UserError.
Certificate selfMadeCertificate(const std::filesystem::path& folder);

}  // namespace bonemill::gateway

#include "common/security/security_folder.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>

#include <array>
#include <memory>
#include <optional>

#include "common/base/user_error.h"
#include "common/files/require_private.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

using DocumentBio = std::unique_ptr<BIO, decltype(&BIO_free_all)>;

std::string contentOf(BIO* bio) {
    char* bytes = nullptr;
    const long count = BIO_get_mem_data(bio, &bytes);
    return {bytes, size_t(count)};
}

// Returns what stands between <tag> and </tag>, without spaces at the ends; empty if there is no such tag.
std::string fieldOf(const std::string& text, const std::string& tag) {
    const size_t begin = text.find("<" + tag + ">");
    const size_t end = text.find("</" + tag + ">");
    if (begin == std::string::npos || end == std::string::npos) return "";
    const size_t first = begin + tag.size() + 2;
    return end < first ? "" : text.substr(first, end - first);
}

std::optional<std::time_t> timeOf(const std::string& text) {
    std::tm parts{};
    const char* const rest = strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S", &parts);
    if (!rest || std::string(rest) != "Z") return std::nullopt;  // not as make-session writes it
    return timegm(&parts);
}

// Returns what this certificate authority has signed: the rules of a session, or what a person may write and
// read (.p7s). Throws UserError when the file cannot be read, or the authority has not signed it.
std::string signedText(const fs::path& file, const Certificate& authority) {
    const DocumentBio bio(BIO_new_file(file.c_str(), "r"), BIO_free_all);
    if (!bio) throw UserError(file.string() + " cannot be read");
    BIO* raw_content = nullptr;
    const std::unique_ptr<PKCS7, decltype(&PKCS7_free)> document(SMIME_read_PKCS7(bio.get(), &raw_content),
                                                                 PKCS7_free);
    const DocumentBio content(raw_content, BIO_free_all), text(BIO_new(BIO_s_mem()), BIO_free_all);
    const std::unique_ptr<STACK_OF(X509), void (*)(STACK_OF(X509)*)> signers(
        sk_X509_new_null(), [](STACK_OF(X509) * stack) { sk_X509_free(stack); });
    sk_X509_push(signers.get(), const_cast<X509*>(authority.get()));
    const bool is_signed =
        document && PKCS7_verify(document.get(), signers.get(), nullptr, content.get(), text.get(),
                                 PKCS7_TEXT | PKCS7_NOVERIFY | PKCS7_NOINTERN) == 1;
    ERR_clear_error();
    if (!is_signed) throw UserError(file.string() + " was not signed by this folder's permissions_ca.pem");
    return contentOf(text.get());
}

// Throws UserError unless the permissions are for this certificate's owner, and valid at that unix time. The
// rest of them is DDS Security's business.
void requirePermissionsFor(const std::string& text, const Certificate& owner, std::time_t now) {
    const std::string subject = fieldOf(text, "subject_name");
    if (subject != owner.subject())
        throw UserError("permissions.p7s is for " + subject + ", but identity.pem for " + owner.subject());
    const auto first = timeOf(fieldOf(text, "not_before")), last = timeOf(fieldOf(text, "not_after"));
    if (first && last)
        requireBetween(now, *first, *last, "what " + owner.identity().name + " may do (permissions.p7s)");
}

// A property of DDS Security, and its file in the folder.
constexpr std::array<std::pair<const char*, const char*>, 6> kFiles{{
    {"dds.sec.auth.identity_ca", "identity_ca.pem"},
    {"dds.sec.auth.identity_certificate", "identity.pem"},
    {"dds.sec.auth.private_key", "identity.key"},
    {"dds.sec.access.permissions_ca", "permissions_ca.pem"},
    {"dds.sec.access.governance", "governance.p7s"},
    {"dds.sec.access.permissions", "permissions.p7s"},
}};

struct Plugin {
    const char* kind;      // in the properties
    const char* library;   // its file
    const char* function;  // what the library's functions end with
};
constexpr std::array<Plugin, 3> kPlugins{{
    {"auth", "libdds_security_auth.so", "authentication"},
    {"access", "libdds_security_ac.so", "access_control"},
    {"crypto", "libdds_security_crypto.so", "crypto"},
}};

void requireFiles(const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error))
        throw UserError("there is no such folder; deploy/security/make-session makes one for each person");
    for (const auto& [property, file] : kFiles)
        if (!fs::is_regular_file(folder / file, error))
            throw UserError(std::string(file) +
                            " is missing: copy the whole folder that deploy/security/make-session has made");
}

Identity checked(const fs::path& folder, std::time_t now) {
    requireFiles(folder);
    requirePrivate(folder, "700");
    requirePrivate(folder / "identity.key", "600");
    const Certificate own = Certificate::read(folder / "identity.pem");
    const Certificate identity_ca = Certificate::read(folder / "identity_ca.pem");
    const Certificate permissions_ca = Certificate::read(folder / "permissions_ca.pem");
    if (!own.isIssuedBy(identity_ca))
        throw UserError("identity.pem was not issued by this folder's identity_ca.pem");
    if (!own.hasKey(folder / "identity.key")) throw UserError("identity.key does not belong to identity.pem");
    for (const Certificate* certificate : {&own, &identity_ca, &permissions_ca})
        certificate->requireValidAt(now);
    signedText(folder / "governance.p7s", permissions_ca);
    requirePermissionsFor(signedText(folder / "permissions.p7s", permissions_ca), own, now);
    return own.identity();
}

}  // namespace

SecurityFolder::SecurityFolder(const fs::path& folder, std::time_t now) : folder_(fs::absolute(folder)) {
    try {
        self_ = checked(folder, now);
    } catch (const UserError& error) {
        throw UserError("--secure " + folder.string() + ": " + error.what());
    }
}

std::vector<std::pair<std::string, std::string>> SecurityFolder::properties(const fs::path& plugins) const {
    std::vector<std::pair<std::string, std::string>> all;
    for (const auto& [property, file] : kFiles)
        all.emplace_back(property, "file:" + (folder_ / file).string());
    for (const Plugin& plugin : kPlugins) {
        const std::string prefix = std::string("dds.sec.") + plugin.kind + ".library.";
        all.emplace_back(prefix + "path", (plugins / plugin.library).string());
        all.emplace_back(prefix + "init", std::string("init_") + plugin.function);
        all.emplace_back(prefix + "finalize", std::string("finalize_") + plugin.function);
    }
    return all;
}

fs::path pluginFolder(const fs::path& of_library) {
    std::error_code error;
    for (const fs::path& folder : {of_library / "libddsc0debian", of_library}) {
        bool are_there = true;
        for (const Plugin& plugin : kPlugins)
            are_there &= fs::is_regular_file(folder / plugin.library, error);
        if (are_there) return folder;
    }
    throw UserError("--secure: Cyclone DDS has no security plugins (libdds_security_auth.so and others) in " +
                    of_library.string() + ": install libddsc0debian");
}

}  // namespace bonemill

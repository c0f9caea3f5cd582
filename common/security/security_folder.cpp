#include "common/security/security_folder.h"

#include <spdlog/spdlog.h>

#include <array>

#include "common/base/user_error.h"
#include "common/security/signed_document.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

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

// Another user who can read the key can be this one.
void warnOfReadableKey(const fs::path& key) {
    std::error_code error;
    if ((fs::status(key, error).permissions() & (fs::perms::group_read | fs::perms::others_read)) !=
        fs::perms::none)
        spdlog::warn("{} can be read by others; type: chmod 600 {}", key.string(), key.string());
}

Identity checked(const fs::path& folder, std::time_t now) {
    requireFiles(folder);
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
    warnOfReadableKey(folder / "identity.key");
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

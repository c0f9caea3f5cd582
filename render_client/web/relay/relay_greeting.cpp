#include "render_client/web/relay/relay_greeting.h"

#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "common/base/user_error.h"
#include "common/files/require_file.h"

namespace bonemill {
namespace {

constexpr size_t kShortestSecret = 32, kLongestSecret = 4096;

}  // namespace

std::string greetingOf(RelayAsk ask, const GuestId& guest) {
    std::string greeting(kRelayMagic);
    greeting += static_cast<char>(ask);
    greeting.append(guest.data(), guest.size());
    return greeting;
}

RelayProof proofOf(std::string_view secret, std::string_view greeting, const RelayNonce& nonce) {
    std::string said(greeting);
    said.append(nonce.data(), nonce.size());
    RelayProof proof{};
    unsigned size = 0;
    if (HMAC(EVP_sha256(), secret.data(), int(secret.size()),
             reinterpret_cast<const unsigned char*>(said.data()), said.size(),
             reinterpret_cast<unsigned char*>(proof.data()), &size) == nullptr)
        throw std::runtime_error("HMAC-SHA256 failed");
    return proof;
}

std::string readRelaySecret(const std::string& path) {
    requireFile(path);
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    const std::string how =
        "mkdir -p " + folder.string() + " && (umask 077; openssl rand -hex 32 > " + path + ")";
    struct stat status {};
    if (stat(path.c_str(), &status) != 0)
        throw UserError(path + ": there is no secret of a relay; make one: " + how);
    if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
        throw UserError(path + ": others may read this secret; type: chmod 600 " + path);
    std::ifstream file(path, std::ios::binary);
    std::string secret(kLongestSecret, '\0');
    file.read(secret.data(), std::streamsize(secret.size()));
    secret.resize(size_t(file.gcount()));
    constexpr const char* kBlanks = " \t\r\n";
    secret.erase(0, std::min(secret.find_first_not_of(kBlanks), secret.size()));
    secret.erase(secret.find_last_not_of(kBlanks) + 1);
    if (secret.size() < kShortestSecret)
        throw UserError(path + ": a relay's secret has at least 32 letters; make one: " + how);
    return secret;
}

}  // namespace bonemill

#include "common/secrets/secrets.h"

#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <openssl/sha.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "common/base/user_error.h"
#include "common/files/require_file.h"

namespace bonemill {

std::string hexOf(std::span<const unsigned char> bytes) {
    std::string hex;
    for (const unsigned char byte : bytes) {
        hex += "0123456789abcdef"[byte >> 4];
        hex += "0123456789abcdef"[byte & 15];
    }
    return hex;
}

std::string sha256Hex(std::string_view bytes) {
    std::array<unsigned char, SHA256_DIGEST_LENGTH> hash{};
    SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), hash.data());
    return hexOf(hash);
}

void fillRandom(void* bytes, size_t count) {
    if (RAND_bytes(static_cast<unsigned char*>(bytes), int(count)) != 1)
        throw std::runtime_error("there are no random numbers");
}

std::string randomToken() {
    std::array<unsigned char, 16> bytes{};
    fillRandom(bytes.data(), bytes.size());
    return hexOf(bytes);
}

bool isSameSecret(std::string_view a, std::string_view b) {
    return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string readSecret(const std::string& path, const std::string& whose) {
    constexpr size_t kShortest = 32, kLongest = 4096;
    requireFile(path);
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    const std::string how =
        "mkdir -p " + folder.string() + " && (umask 077; openssl rand -hex 32 > " + path + ")";
    struct stat status {};
    if (stat(path.c_str(), &status) != 0)
        throw UserError(path + ": there is no secret of " + whose + "; make one: " + how);
    if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
        throw UserError(path + ": others may read this secret; type: chmod 600 " + path);
    std::ifstream file(path, std::ios::binary);
    std::string secret(kLongest, '\0');
    file.read(secret.data(), std::streamsize(secret.size()));
    secret.resize(size_t(file.gcount()));
    constexpr const char* kBlanks = " \t\r\n";
    secret.erase(0, std::min(secret.find_first_not_of(kBlanks), secret.size()));
    secret.erase(secret.find_last_not_of(kBlanks) + 1);
    if (secret.size() < kShortest)
        throw UserError(path + ": the secret of " + whose + " has at least 32 letters; make one: " + how);
    return secret;
}

}  // namespace bonemill

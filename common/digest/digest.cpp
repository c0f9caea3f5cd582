#include "common/digest/digest.h"

#include <openssl/evp.h>
#include <openssl/sha.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include "common/base/user_error.h"
#include "common/files/require_file.h"

namespace bonemill {

Sha256::Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    if (!context_) throw std::bad_alloc();
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
}

void Sha256::add(std::string_view bytes) {
    EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size());
}

std::string Sha256::take() {
    std::string digest(kBytes, '\0');
    EVP_DigestFinal_ex(context_.get(), reinterpret_cast<unsigned char*>(digest.data()), nullptr);
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
    return digest;
}

std::string hexOf(std::string_view bytes) {
    std::string text;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        text += "0123456789abcdef"[byte / 16];
        text += "0123456789abcdef"[byte % 16];
    }
    return text;
}

std::string sha256OfText(std::string_view text) {
    Sha256 hash;
    hash.add(text);
    return hexOf(hash.take());
}

std::string sha256OfFile(const std::filesystem::path& path) {
    requireFile(path);
    const std::unique_ptr<std::FILE, decltype(&std::fclose)> file(std::fopen(path.c_str(), "rbe"),
                                                                  std::fclose);
    if (!file) throw UserError(path.string() + ": cannot be read (" + std::strerror(errno) + ")");
    Sha256 hash;
    std::string bytes(size_t(1) << 20, '\0');
    while (const size_t count = std::fread(bytes.data(), 1, bytes.size(), file.get()))
        hash.add(std::string_view(bytes).substr(0, count));
    if (std::ferror(file.get())) throw UserError(path.string() + ": cannot be read to its end");
    return hexOf(hash.take());
}

std::string uuidOfName(const UuidBytes& name_space, std::string_view name) {
    std::string bytes(name_space.begin(), name_space.end());
    bytes += name;
    unsigned char hash[SHA_DIGEST_LENGTH];
    SHA1(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), hash);
    hash[6] = (hash[6] & 0x0f) | 0x50;  // the version
    hash[8] = (hash[8] & 0x3f) | 0x80;  // the variant
    std::string text = hexOf({reinterpret_cast<const char*>(hash), sizeof(UuidBytes)});
    for (const size_t at : {20, 16, 12, 8}) text.insert(at, 1, '-');
    return text;
}

}  // namespace bonemill

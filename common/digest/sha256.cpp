#include "common/digest/sha256.h"

#include <openssl/evp.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include "common/base/user_error.h"
#include "common/files/require_file.h"

namespace bonemill {

struct Sha256::Context {
    Context() : digest(EVP_MD_CTX_new()) {
        if (!digest) throw std::bad_alloc();
    }
    ~Context() { EVP_MD_CTX_free(digest); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    EVP_MD_CTX* const digest;
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
    EVP_DigestInit_ex(context_->digest, EVP_sha256(), nullptr);
}
Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
    EVP_DigestUpdate(context_->digest, bytes.data(), bytes.size());
}

std::string Sha256::take() {
    std::string digest(kBytes, '\0');
    EVP_DigestFinal_ex(context_->digest, reinterpret_cast<unsigned char*>(digest.data()), nullptr);
    EVP_DigestInit_ex(context_->digest, EVP_sha256(), nullptr);
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

}  // namespace bonemill

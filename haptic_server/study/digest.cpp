#include "haptic_server/study/digest.h"

#include <openssl/evp.h>

#include <fstream>
#include <iterator>
#include <new>

namespace bonemill::study {

std::string sha256Of(std::string_view bytes) {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned size = 0;
    if (!EVP_Digest(bytes.data(), bytes.size(), digest, &size, EVP_sha256(), nullptr)) throw std::bad_alloc();
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
        text += "0123456789abcdef"[digest[i] >> 4];
        text += "0123456789abcdef"[digest[i] & 15];
    }
    return text;
}

std::string sha256OfFile(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file || !std::filesystem::is_regular_file(path)) return {};
    return sha256Of(std::string(std::istreambuf_iterator<char>(file), {}));
}

}  // namespace bonemill::study

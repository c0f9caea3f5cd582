#include "common/digest/name_uuid.h"

#include <openssl/sha.h>

#include "common/digest/sha256.h"

namespace bonemill {

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

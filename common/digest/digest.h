// SHA-256, which says what exactly was used or written, and UUIDs. Each object is for one normal thread.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // OpenSSL's EVP_MD_CTX

namespace bonemill {

class Sha256 {
  public:
    static constexpr size_t kBytes = 32;

    Sha256();
    void add(std::string_view bytes);
    // Of all that was added; it begins anew after it.
    std::string take();

  private:
    std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

// Two digits per byte.
std::string hexOf(std::string_view bytes);
// As 64 hexadecimal digits.
std::string sha256OfText(std::string_view text);
// Of a file's bytes. Throws UserError if it is no file, or cannot be read; a pipe or a device would never
// end.
std::string sha256OfFile(const std::filesystem::path& path);

using UuidBytes = std::array<uint8_t, 16>;

// The namespace of URLs, RFC 4122, appendix C.
inline constexpr UuidBytes kUrlNames{0x6b, 0xa7, 0xb8, 0x11, 0x9d, 0xad, 0x11, 0xd1,
                                     0x80, 0xb4, 0x00, 0xc0, 0x4f, 0xd4, 0x30, 0xc8};

// Makes a UUID of a name, version 5 of RFC 4122, 4.3, with SHA-1: "xxxxxxxx-xxxx-5xxx-xxxx-xxxxxxxxxxxx".
std::string uuidOfName(const UuidBytes& name_space, std::string_view name);

}  // namespace bonemill

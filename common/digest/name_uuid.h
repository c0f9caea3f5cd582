// UUIDs made from names: version 5 of RFC 4122, 4.3, with SHA-1. Pure; any thread may call it, it allocates.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace bonemill {

using UuidBytes = std::array<uint8_t, 16>;

// Namespaces of RFC 4122, appendix C: of domain names, and of URLs.
inline constexpr UuidBytes kDnsNames{0x6b, 0xa7, 0xb8, 0x10, 0x9d, 0xad, 0x11, 0xd1,
                                     0x80, 0xb4, 0x00, 0xc0, 0x4f, 0xd4, 0x30, 0xc8};
inline constexpr UuidBytes kUrlNames{0x6b, 0xa7, 0xb8, 0x11, 0x9d, 0xad, 0x11, 0xd1,
                                     0x80, 0xb4, 0x00, 0xc0, 0x4f, 0xd4, 0x30, 0xc8};

// As text, "xxxxxxxx-xxxx-5xxx-xxxx-xxxxxxxxxxxx".
std::string uuidOfName(const UuidBytes& name_space, std::string_view name);

}  // namespace bonemill

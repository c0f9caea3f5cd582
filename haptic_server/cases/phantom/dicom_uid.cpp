#include "haptic_server/cases/phantom/dicom_uid.h"

#include <algorithm>
#include <cstdint>

namespace bonemill {
namespace {

uint64_t fnv1a(const std::string& text, uint64_t hash) {
    for (const unsigned char c : text) hash = (hash ^ c) * 0x100000001b3u;
    return hash;
}

}  // namespace

std::string uidFromText(const std::string& text) {
    // It follows RFC 9562 version 8 (own hash), variant 1, written as one decimal number (ITU-T X.667).
    const uint64_t high = (fnv1a(text, 0xcbf29ce484222325u) & ~uint64_t(0xf000)) | 0x8000;
    const uint64_t low = (fnv1a(text, 0x9ae16a3b2f90404fu) & 0x3fffffffffffffffu) | 0x8000000000000000u;
    unsigned __int128 number = static_cast<unsigned __int128>(high) << 64 | low;
    std::string digits;
    for (; number > 0; number /= 10) digits += char('0' + int(number % 10));
    return "2.25." + std::string(digits.rbegin(), digits.rend());
}

}  // namespace bonemill

// The elements of which DICOM files are written byte by byte (explicit VR little endian).
#pragma once

#include <cstdint>
#include <string>

namespace bonemill::dicom {

inline std::string number(uint32_t value, int bytes) {
    std::string text;
    for (int b = 0; b < bytes; ++b) text += char(value >> (8 * b) & 0xff);
    return text;
}

inline std::string element(uint32_t tag, const std::string& vr, std::string value) {
    const bool is_long = vr == "OB" || vr == "OW" || vr == "SQ" || vr == "UN";
    if (value.size() % 2) value += vr == "UI" || vr == "OB" ? '\0' : ' ';
    std::string bytes = number(tag >> 16, 2) + number(tag & 0xffff, 2) + vr;
    bytes += is_long ? std::string(2, '\0') + number(uint32_t(value.size()), 4)
                     : number(uint32_t(value.size()), 2);
    return bytes + value;
}

inline std::string shortElement(uint32_t tag, int value) {
    return element(tag, "US", number(uint32_t(value), 2));
}

inline std::string item(const std::string& content) {
    return number(0xe000fffe, 4) + number(uint32_t(content.size()), 4) + content;
}

// Preamble and group 0002.
inline std::string metaHeader(const std::string& sop_class, const std::string& sop_uid,
                              const std::string& transfer_syntax) {
    const std::string content = element(0x00020001, "OB", std::string("\0\1", 2)) +
                                element(0x00020002, "UI", sop_class) + element(0x00020003, "UI", sop_uid) +
                                element(0x00020010, "UI", transfer_syntax) +
                                element(0x00020012, "UI", "1.2.3.4.5");
    return std::string(128, '\0') + "DICM" + element(0x00020000, "UL", number(uint32_t(content.size()), 4)) +
           content;
}

}  // namespace bonemill::dicom

// Writes a data set of explicit VR little endian (dicom_bytes.h) in the other codings without compression.
#pragma once

#include <algorithm>
#include <string>

#include "tests/unit/haptic_server/scans/import/dicom_elements.h"

namespace bonemill::dicom {

struct Coding {
    bool is_implicit = false, is_big_endian = false;

    std::string put(uint32_t value, int bytes) const {
        std::string text = number(value, bytes);
        if (is_big_endian) std::ranges::reverse(text);
        return text;
    }
};

inline uint32_t numberAt(const std::string& bytes, size_t at, int count) {
    uint32_t value = 0;
    for (int b = 0; b < count; ++b) value |= uint32_t(uint8_t(bytes[at + size_t(b)])) << (8 * b);
    return value;
}

inline size_t wordSize(const std::string& vr) {
    if (vr == "US" || vr == "SS" || vr == "OW") return 2;
    return vr == "UL" ? 4 : vr == "FD" ? 8 : 1;
}

std::string recoded(const std::string& elements, const Coding& coding);

inline std::string recodedItems(const std::string& items, const Coding& coding) {
    std::string bytes;
    for (size_t at = 0; at < items.size();) {
        const size_t length = numberAt(items, at + 4, 4);
        const std::string content = recoded(items.substr(at + 8, length), coding);
        bytes +=
            coding.put(0xfffe, 2) + coding.put(0xe000, 2) + coding.put(uint32_t(content.size()), 4) + content;
        at += 8 + length;
    }
    return bytes;
}

inline std::string recoded(const std::string& elements, const Coding& coding) {
    std::string bytes;
    for (size_t at = 0; at < elements.size();) {
        const std::string vr = elements.substr(at + 4, 2);
        const bool is_long = vr == "OB" || vr == "OW" || vr == "SQ" || vr == "UN";
        const size_t length = is_long ? numberAt(elements, at + 8, 4) : numberAt(elements, at + 6, 2);
        const size_t begin = at + (is_long ? 12 : 8);
        std::string value = elements.substr(begin, length);
        if (vr == "SQ") value = recodedItems(value, coding);
        for (size_t n = 0; coding.is_big_endian && n < value.size() && vr != "SQ"; n += wordSize(vr))
            std::reverse(value.begin() + ptrdiff_t(n), value.begin() + ptrdiff_t(n + wordSize(vr)));
        bytes += coding.put(numberAt(elements, at, 2), 2) + coding.put(numberAt(elements, at + 2, 2), 2);
        if (!coding.is_implicit) bytes += vr + (is_long ? std::string(2, '\0') : "");
        bytes += coding.put(uint32_t(value.size()), is_long || coding.is_implicit ? 4 : 2) + value;
        at = begin + length;
    }
    return bytes;
}

// Of a whole file whose meta header names the other coding.
inline std::string recodedFile(const std::string& file, const Coding& coding) {
    const size_t meta = 128 + 4 + 12 + numberAt(file, 128 + 4 + 8, 4);  // behind the group's length
    return file.substr(0, meta) + recoded(file.substr(meta), coding);
}

}  // namespace bonemill::dicom

// Writes small pictures byte by byte.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>

namespace bonemill {

struct Picture {
    int width = 5, height = 4, bits = 16, channels = 1;
    int slice = 0;

    int value(int i, int j) const {
        return bits == 8 ? i + 10 * j + 40 * slice : i + 10 * j + 100 * slice + 1000;
    }
};

inline Picture pictureOf(int bits) {
    Picture picture;
    picture.bits = bits;
    return picture;
}

inline std::string bigEndian(uint32_t number, int bytes) {
    std::string text;
    for (int b = bytes - 1; b >= 0; --b) text += char(number >> (8 * b) & 0xff);
    return text;
}

inline std::string pngChunk(const std::string& type, const std::string& data) {
    const std::string body = type + data;
    const auto sum = uint32_t(crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size())));
    return bigEndian(uint32_t(data.size()), 4) + body + bigEndian(sum, 4);
}

inline std::string png(const Picture& picture) {
    std::string rows;
    for (int j = 0; j < picture.height; ++j) {
        rows += '\0';  // no filter
        for (int i = 0; i < picture.width; ++i)
            for (int c = 0; c < picture.channels; ++c)
                rows += bigEndian(uint32_t(picture.value(i, j)), picture.bits / 8);
    }
    uLongf size = compressBound(uLong(rows.size()));
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
             uLong(rows.size()));
    packed.resize(size);
    const char color = picture.channels == 1 ? 0 : 2;
    const std::string head = bigEndian(uint32_t(picture.width), 4) + bigEndian(uint32_t(picture.height), 4) +
                             char(picture.bits) + color + std::string(3, '\0');
    return "\x89PNG\r\n\x1a\n" + pngChunk("IHDR", head) + pngChunk("IDAT", packed) + pngChunk("IEND", "");
}

// Big-endian, one strip, not compressed.
inline std::string tiff(const Picture& picture) {
    std::string pixels;
    for (int j = 0; j < picture.height; ++j)
        for (int i = 0; i < picture.width; ++i)
            pixels += bigEndian(uint32_t(picture.value(i, j)), picture.bits / 8);
    const auto entry = [](uint32_t tag, uint32_t value) {  // a long
        return bigEndian(tag, 2) + bigEndian(4, 2) + bigEndian(1, 4) + bigEndian(value, 4);
    };
    const auto entryShort = [](uint32_t tag, uint32_t value) {
        return bigEndian(tag, 2) + bigEndian(3, 2) + bigEndian(1, 4) + bigEndian(value, 2) + bigEndian(0, 2);
    };
    const std::string directory =
        bigEndian(9, 2) + entry(256, uint32_t(picture.width)) + entry(257, uint32_t(picture.height)) +
        entryShort(258, uint32_t(picture.bits)) + entryShort(259, 1) + entryShort(262, 1) + entry(273, 8) +
        entryShort(277, 1) + entry(278, uint32_t(picture.height)) + entry(279, uint32_t(pixels.size())) +
        bigEndian(0, 4);
    return std::string("MM") + bigEndian(42, 2) + bigEndian(uint32_t(8 + pixels.size()), 4) + pixels +
           directory;
}

}  // namespace bonemill

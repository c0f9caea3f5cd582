#include "haptic_server/scans/dicom/coded_picture.h"

#include <algorithm>

namespace bonemill {
namespace {

using namespace std::literals;

constexpr std::string_view kJpegStart = "\xff\xd8"sv;
constexpr std::string_view kJpeg2000Start = "\xff\x4f\xff\x51"sv;  // its first segment is the size
constexpr std::string_view kJp2Start = "\0\0\0\x0cjP  "sv;         // the same within a file of boxes

uint64_t bigEndian(std::string_view bytes, size_t at, size_t count) {
    uint64_t value = 0;
    for (size_t n = 0; n < count; ++n) value = value << 8 | uint8_t(bytes[at + n]);
    return value;
}

uint64_t littleEndian(std::string_view bytes, size_t at) {
    uint64_t value = 0;
    for (size_t n = 4; n-- > 0;) value = value << 8 | uint8_t(bytes[at + n]);
    return value;
}

// ISO 10918-1 B.1: frames of all processes but the tables and extensions between them; JPEG-LS has its own.
bool isStartOfFrame(uint8_t marker) {
    const bool is_table = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
    return (marker >= 0xc0 && marker <= 0xcf && !is_table) || marker == 0xf7;
}

std::optional<CodedHead> jpegHeadOf(std::string_view bytes) {
    constexpr size_t kFrameBytes = 10;  // marker, length, precision, lines, samples per line, components
    for (size_t at = kJpegStart.size(); at + kFrameBytes <= bytes.size();) {
        if (uint8_t(bytes[at]) != 0xff) return std::nullopt;
        const auto marker = uint8_t(bytes[at + 1]);
        if (isStartOfFrame(marker))
            return CodedHead{.columns = bigEndian(bytes, at + 7, 2),
                             .rows = bigEndian(bytes, at + 5, 2),
                             .samples = int(bigEndian(bytes, at + 9, 1)),
                             .bits = unsigned(bigEndian(bytes, at + 4, 1)),
                             .is_signed = {}};
        at += marker == 0xff ? 1 : 2 + bigEndian(bytes, at + 2, 2);  // more of the same fill up
    }
    return std::nullopt;
}

// ISO 15444-1 A.5.1: area, offset, tile, number of components, and of each of them its bits.
std::optional<CodedHead> jpeg2000HeadOf(std::string_view bytes) {
    constexpr size_t kArea = 8, kOffset = 16, kComponents = 40, kBits = 42;
    if (bytes.size() <= kBits) return std::nullopt;
    const auto bits = uint8_t(bytes[kBits]);
    return CodedHead{.columns = bigEndian(bytes, kArea, 4) - bigEndian(bytes, kOffset, 4),
                     .rows = bigEndian(bytes, kArea + 4, 4) - bigEndian(bytes, kOffset + 4, 4),
                     .samples = int(bigEndian(bytes, kComponents, 2)),
                     .bits = (bits & 0x7fu) + 1,
                     .is_signed = (bits & 0x80) != 0};
}

// PackBits: a count below 128 is followed by one byte more than that, one above by a byte that is repeated.
uint64_t unpackedSize(std::string_view packed) {
    uint64_t size = 0;
    for (size_t at = 0; at + 1 < packed.size();) {
        const auto count = uint8_t(packed[at]);
        if (count < 128) {
            size += std::min<size_t>(count + 1u, packed.size() - at - 1);
            at += count + 2u;
        } else {
            size += count == 128 ? 0 : 257u - count;
            at += count == 128 ? 1 : 2;
        }
    }
    return size;
}

}  // namespace

bool beginsPicture(std::string_view bytes) {
    return bytes.starts_with(kJpegStart) || bytes.starts_with(kJpeg2000Start) || bytes.starts_with(kJp2Start);
}

std::optional<CodedHead> codedHeadOf(std::string_view bytes) {
    if (bytes.starts_with(kJpegStart)) return jpegHeadOf(bytes);
    if (bytes.starts_with(kJpeg2000Start)) return jpeg2000HeadOf(bytes);
    if (!bytes.starts_with(kJp2Start)) return std::nullopt;
    const size_t begin = bytes.find(kJpeg2000Start);
    return begin == std::string_view::npos ? std::nullopt : jpeg2000HeadOf(bytes.substr(begin));
}

std::vector<uint64_t> rleSegmentSizes(std::string_view bytes) {
    constexpr size_t kHeadBytes = 64, kMostSegments = 15;
    if (bytes.size() < kHeadBytes) return {};
    const uint64_t count = littleEndian(bytes, 0);
    if (count > kMostSegments) return {};
    std::vector<uint64_t> sizes;
    for (size_t n = 0; n < count; ++n) {
        const uint64_t begin = littleEndian(bytes, 4 + 4 * n);
        const uint64_t end = n + 1 < count ? littleEndian(bytes, 8 + 4 * n) : bytes.size();
        if (begin < kHeadBytes || begin > end || end > bytes.size()) return {};
        sizes.push_back(unpackedSize(bytes.substr(begin, end - begin)));
    }
    return sizes;
}

}  // namespace bonemill

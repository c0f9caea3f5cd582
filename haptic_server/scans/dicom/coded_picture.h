// What the first bytes of a compressed picture say of it, in its own coding: JPEG, JPEG-LS, JPEG 2000, RLE.
// There is no DICOM library in here.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace bonemill {

struct CodedHead {
    uint64_t columns = 0, rows = 0;
    int samples = 1;  // per pixel
    unsigned bits = 0;
    std::optional<bool> is_signed;  // nothing: the coding does not say it
};

// Do the bytes begin as a picture in JPEG, JPEG-LS or JPEG 2000 does? In their middle no part of one does.
bool beginsPicture(std::string_view bytes);

// Nothing where there is no such head.
std::optional<CodedHead> codedHeadOf(std::string_view bytes);

// Of a picture in RLE (PS3.5 annex G), which says no size: how many bytes each of its segments makes. Empty
// where its head is damaged.
std::vector<uint64_t> rleSegmentSizes(std::string_view bytes);

}  // namespace bonemill

#include "haptic_server/scans/dicom/coded_frames.h"

#include <gdcmByteValue.h>
#include <gdcmFragment.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/scans/dicom/coded_picture.h"

namespace bonemill {
namespace {

std::string_view fragmentBytes(const gdcm::SequenceOfFragments& fragments, size_t n) {
    const gdcm::ByteValue* const bytes = fragments.GetFragment(n).GetByteValue();
    return bytes ? std::string_view(bytes->GetPointer(), bytes->GetLength()) : std::string_view();
}

// In codings that show where a picture begins, the fragments up to the next one belong to it; in others each
// fragment is a picture, or all are parts of a file's only one.
std::vector<std::string> picturesOf(const gdcm::SequenceOfFragments& fragments, size_t frames, bool is_rle) {
    const bool is_shown = !is_rle && beginsPicture(fragmentBytes(fragments, 0));
    std::vector<std::string> pictures;
    for (size_t n = 0; n < fragments.GetNumberOfFragments(); ++n) {
        const std::string_view bytes = fragmentBytes(fragments, n);
        if (bytes.empty()) continue;
        if (pictures.empty() || (is_shown ? beginsPicture(bytes) : frames > 1))
            pictures.emplace_back(bytes);
        else
            pictures.back() += bytes;
    }
    return pictures;
}

void requireCount(size_t pictures, size_t frames, const std::string& file) {
    if (pictures != frames)
        throw UserError(file + ": Pixel Data holds " + std::to_string(pictures) +
                        " compressed pictures, its " + std::to_string(frames) +
                        " frames need one each; export it anew");
}

[[noreturn]] void refuse(const std::string& picture, const std::string& own, const std::string& header) {
    throw UserError(picture + ": its compressed picture has " + own + ", its DICOM header says " + header +
                    "; export it anew");
}

// Bits of whole words stand where the header has them, those of values at the lower end.
void checkBits(const CodedHead& head, const StoredBits& bits, const std::string& picture) {
    const bool is_shifted = bits.high + 1 != bits.stored;
    if (head.bits != bits.allocated && (is_shifted || head.bits != bits.stored))
        refuse(picture, std::to_string(head.bits) + " bits per value",
               "Bits Allocated " + std::to_string(bits.allocated) + ", Bits Stored " +
                   std::to_string(bits.stored) + ", High Bit " + std::to_string(bits.high));
    if (head.is_signed && *head.is_signed != bits.is_signed)
        refuse(picture, *head.is_signed ? "signed values" : "values without a sign",
               std::string("that they are ") + (bits.is_signed ? "signed" : "without a sign") +
                   " (Pixel Representation)");
}

void checkHead(const CodedHead& head, const DicomPixelLayout& layout, const std::string& picture) {
    if (head.columns != uint64_t(layout.columns) || head.rows != uint64_t(layout.rows))
        refuse(picture, std::to_string(head.rows) + " x " + std::to_string(head.columns) + " pixels",
               "Rows x Columns of " + std::to_string(layout.rows) + " x " + std::to_string(layout.columns));
    if (head.samples != layout.samples_per_pixel)
        refuse(picture, std::to_string(head.samples) + " values per pixel",
               "Samples per Pixel " + std::to_string(layout.samples_per_pixel));
    checkBits(head, layout.bits, picture);
}

// A segment is one byte of each word.
void checkRle(std::string_view bytes, const DicomPixelLayout& layout, const std::string& picture) {
    const uint64_t pixels = uint64_t(layout.rows) * uint64_t(layout.columns);
    const std::vector<uint64_t> sizes = rleSegmentSizes(bytes);
    if (sizes.size() != layout.bits.allocated / 8)
        refuse(picture, std::to_string(sizes.size()) + " segments (RLE)",
               "Bits Allocated " + std::to_string(layout.bits.allocated));
    for (const uint64_t size : sizes)
        if (size != pixels)
            refuse(
                picture, std::to_string(size) + " pixels (RLE)",
                "Rows x Columns of " + std::to_string(layout.rows) + " x " + std::to_string(layout.columns));
}

}  // namespace

CodedFrames codedFramesOf(const gdcm::SequenceOfFragments* fragments, const DicomPixelLayout& layout,
                          bool is_rle, const std::string& file) {
    std::vector<std::string> pictures;
    if (fragments && fragments->GetNumberOfFragments() > 0)
        pictures = picturesOf(*fragments, layout.frames, is_rle);
    requireCount(pictures.size(), layout.frames, file);
    CodedFrames frames{new gdcm::SequenceOfFragments, 0};
    for (size_t n = 0; n < pictures.size(); ++n) {
        const std::string name = file + (layout.frames > 1 ? " frame " + std::to_string(n + 1) : "");
        const auto head = is_rle ? std::nullopt : codedHeadOf(pictures[n]);
        if (is_rle) checkRle(pictures[n], layout, name);
        if (head) checkHead(*head, layout, name);
        frames.bits = std::max(frames.bits, head ? head->bits : 0);
        gdcm::Fragment piece;
        piece.SetByteValue(pictures[n].data(), uint32_t(pictures[n].size()));
        frames.pieces->AddFragment(piece);
    }
    return frames;
}

}  // namespace bonemill

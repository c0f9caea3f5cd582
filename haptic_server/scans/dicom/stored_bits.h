// How a DICOM value lies in the bits of its word (PS3.5 8.1.1), which words are no data, and what stored
// values become. There is no DICOM library in here.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "haptic_server/core/volume/raw_values.h"
#include "haptic_server/scans/pixels/dicom_rescale.h"

namespace bonemill {

// Overlays may lie in the bits of a word that its value does not use.
struct StoredBits {
    unsigned allocated = 16;  // of a word: 8, 16 or 32
    unsigned stored = 16;     // of a value
    unsigned high = 15;       // the value's highest bit in its word
    bool is_signed = false;

    // No value has other bits than its word, and no words are of other sizes.
    bool arePossible() const noexcept;
    int64_t valueOf(uint32_t word) const noexcept {
        const uint32_t top = word << (31 - high);
        const unsigned down = 32 - stored;
        return is_signed ? int64_t(int32_t(top) >> down) : int64_t(top >> down);
    }
};

// Values from `low` to `high` are no data.
struct PixelPadding {
    StoredBits bits;
    int64_t low = 0, high = 0;

    bool holds(uint32_t word) const noexcept {
        const int64_t value = bits.valueOf(word);
        return value >= low && value <= high;
    }
};

// Of the 16 bits of Pixel Padding Value and of its Range Limit, which are signed where the pixels are,
// whatever the file says of them. What values of so few bits cannot hold is sought in whole words.
PixelPadding paddingOf(uint16_t value, std::optional<uint16_t> limit, const StoredBits& bits);

struct FrameValues {
    struct Run {
        size_t begin, end;
    };
    RawValues values;  // the frame's lowest value where there is no data, 0 where there is none at all
    std::vector<Run> padding;  // where there is no data
    bool has_data = true;
};

// `bytes` are words of the machine's order, one behind the other.
FrameValues valuesOf(std::span<const char> bytes, const StoredBits& bits,
                     const std::optional<PixelPadding>& padding, const DicomRescale& rescale);

// Joins the frames of a volume. What is no data becomes the lowest value of all.
class JoinedFrames {
  public:
    explicit JoinedFrames(RawValues& values) : values_(values) {}

    void append(const FrameValues& frame);
    void finish();  // after the last frame
    size_t paddingCount() const noexcept;

  private:
    void fill(size_t size, double value);  // up to this size

    RawValues& values_;
    size_t size_ = 0;
    std::vector<FrameValues::Run> padding_;
};

}  // namespace bonemill

#include "haptic_server/scans/dicom/stored_bits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace bonemill {
namespace {

struct Range {
    int64_t low = std::numeric_limits<int64_t>::max();
    int64_t high = std::numeric_limits<int64_t>::min();

    bool isEmpty() const { return low > high; }
};

Range rangeOf(const StoredBits& bits) {
    const int64_t count = int64_t(1) << bits.stored;
    return bits.is_signed ? Range{-count / 2, count / 2 - 1} : Range{0, count - 1};
}

StoredBits wholeWord(const StoredBits& bits) {
    return {bits.allocated, bits.allocated, bits.allocated - 1, bits.is_signed};
}

int64_t numberOf(uint16_t pattern, const StoredBits& bits) {
    return bits.is_signed ? int64_t(int16_t(pattern)) : int64_t(pattern);
}

// Some write the bits of a negative value alone, without those above. Nothing: no such value can hold it.
std::optional<int64_t> valueOf(uint16_t pattern, const StoredBits& bits) {
    const int64_t number = numberOf(pattern, bits);
    const Range range = rangeOf(bits);
    if (number >= range.low && number <= range.high) return number;
    if (bits.stored < 16 && pattern >> bits.stored == 0)
        return StoredBits{32, bits.stored, bits.stored - 1, bits.is_signed}.valueOf(pattern);
    return std::nullopt;
}

struct Decoded {
    std::vector<int64_t> values;
    std::vector<FrameValues::Run> padding;
    Range range;  // of what is no padding
};

template <class Word>
Decoded decoded(std::span<const char> bytes, const StoredBits& bits,
                const std::optional<PixelPadding>& padding) {
    Decoded found;
    found.values.resize(bytes.size() / sizeof(Word));
    for (size_t n = 0; n < found.values.size(); ++n) {
        Word word;
        std::memcpy(&word, bytes.data() + n * sizeof word, sizeof word);
        const int64_t value = bits.valueOf(word);
        found.values[n] = value;
        if (padding && padding->holds(word)) {
            if (found.padding.empty() || found.padding.back().end != n) found.padding.push_back({n, n});
            found.padding.back().end = n + 1;
            continue;
        }
        found.range.low = std::min(found.range.low, value);
        found.range.high = std::max(found.range.high, value);
    }
    return found;
}

Decoded decoded(std::span<const char> bytes, const StoredBits& bits,
                const std::optional<PixelPadding>& padding) {
    if (bits.allocated == 8) return decoded<uint8_t>(bytes, bits, padding);
    if (bits.allocated == 16) return decoded<uint16_t>(bytes, bits, padding);
    return decoded<uint32_t>(bytes, bits, padding);
}

// Do all of them become whole numbers that a T holds?
template <class T>
bool canHold(const Range& range, const DicomRescale& rescale) {
    const auto isWithin = [&](int64_t value) {
        const double scaled = rescale.slope * double(value) + rescale.intercept;
        return scaled >= std::numeric_limits<T>::lowest() && scaled <= std::numeric_limits<T>::max();
    };
    return rescale.slope == std::nearbyint(rescale.slope) &&
           rescale.intercept == std::nearbyint(rescale.intercept) && isWithin(range.low) &&
           isWithin(range.high);
}

template <class T>
RawValues scaled(const std::vector<int64_t>& stored, const DicomRescale& rescale) {
    std::vector<T> samples(stored.size());
    std::ranges::transform(stored, samples.begin(), [&](int64_t value) {
        return T(rescale.slope * double(value) + rescale.intercept);
    });
    RawValues values;
    values.append(std::move(samples));
    return values;
}

RawValues scaled(const Decoded& found, const StoredBits& bits, const DicomRescale& rescale) {
    const Range& range = found.range;
    if (bits.allocated == 8 && canHold<uint8_t>(range, rescale))
        return scaled<uint8_t>(found.values, rescale);
    if (canHold<int16_t>(range, rescale)) return scaled<int16_t>(found.values, rescale);
    if (canHold<uint16_t>(range, rescale)) return scaled<uint16_t>(found.values, rescale);
    return scaled<float>(found.values, rescale);
}

}  // namespace

bool StoredBits::arePossible() const noexcept {
    const bool is_word = allocated == 8 || allocated == 16 || allocated == 32;
    return is_word && stored >= 1 && stored <= allocated && high < allocated && high + 1 >= stored;
}

PixelPadding paddingOf(uint16_t value, std::optional<uint16_t> limit, const StoredBits& bits) {
    const auto first = valueOf(value, bits), last = valueOf(limit.value_or(value), bits);
    if (first && last) return {bits, std::min(*first, *last), std::max(*first, *last)};
    const int64_t a = numberOf(value, bits), b = numberOf(limit.value_or(value), bits);
    return {wholeWord(bits), std::min(a, b), std::max(a, b)};
}

FrameValues valuesOf(std::span<const char> bytes, const StoredBits& bits,
                     const std::optional<PixelPadding>& padding, const DicomRescale& rescale) {
    Decoded found = decoded(bytes, bits, padding);
    const bool has_data = !found.range.isEmpty();
    if (!has_data) found.range = {0, 0};
    // The lowest value once it is scaled.
    const int64_t lowest = rescale.slope < 0 ? found.range.high : found.range.low;
    for (const FrameValues::Run& run : found.padding)
        std::fill(found.values.begin() + ptrdiff_t(run.begin), found.values.begin() + ptrdiff_t(run.end),
                  lowest);
    return {scaled(found, bits, rescale), std::move(found.padding), has_data};
}

// Nothing is known of a lowest value before the first data: what came before is filled up with the first one.
void JoinedFrames::append(const FrameValues& frame) {
    for (const FrameValues::Run& run : frame.padding)
        padding_.push_back({size_ + run.begin, size_ + run.end});
    if (frame.has_data) {
        fill(size_, frame.values.range().low);
        frame.values.visit([&](auto samples) { values_.append(samples); });
    }
    size_ += frame.values.size();
    if (!frame.has_data && values_.size() > 0) fill(size_, values_.range().low);
}

void JoinedFrames::finish() {
    fill(size_, 0);  // where there is no data at all
    for (const FrameValues::Run& run : padding_)
        for (size_t n = run.begin; n < run.end; ++n) values_.setToLowest(n);
}

void JoinedFrames::fill(size_t size, double value) {
    if (values_.size() == size) return;
    const std::vector<float> more(size - values_.size(), float(value));
    values_.append(std::span<const float>(more));
}

size_t JoinedFrames::paddingCount() const noexcept {
    size_t count = 0;
    for (const FrameValues::Run& run : padding_) count += run.end - run.begin;
    return count;
}

}  // namespace bonemill

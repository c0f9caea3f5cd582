#include "haptic_server/core/volume/raw_values.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "haptic_server/core/volume/forget_memory.h"

namespace bonemill {
namespace {

template <class T>
ValueRange rangeOf(std::span<const T> samples) {
    if (samples.empty()) return {};
    T low = samples.front(), high = low;
    for (const T sample : samples) {  // plain, for the compiler takes many at a time
        low = std::min(low, sample);
        high = std::max(high, sample);
    }
    return {double(low), double(high), true, 0};
}

template <>
ValueRange rangeOf(std::span<const float> samples) {
    ValueRange range;
    for (const float v : samples) {
        if (!std::isfinite(v)) {
            ++range.non_finite;
            continue;
        }
        range.low = std::min(range.low, double(v));
        range.high = std::max(range.high, double(v));
        range.are_integers = range.are_integers && v == std::nearbyint(v);
    }
    return range;
}

template <class T>
bool canHold(const ValueRange& range) {
    using Limits = std::numeric_limits<T>;
    const bool is_within = range.low >= Limits::lowest() && range.high <= Limits::max();
    return std::is_same_v<T, float> || (range.are_integers && range.non_finite == 0 && is_within);
}

}  // namespace

void ValueRange::include(const ValueRange& other) noexcept {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
    are_integers = are_integers && other.are_integers;
    non_finite += other.non_finite;
}

size_t RawValues::size() const noexcept {
    return visit([](auto samples) { return samples.size(); });
}

float RawValues::operator[](size_t n) const noexcept {
    return visit([n](auto samples) { return float(samples[n]); });
}

bool RawValues::operator==(const RawValues& other) const noexcept {
    return visit([&](auto a) { return other.visit([&](auto b) { return std::ranges::equal(a, b); }); });
}

template <class T>
void RawValues::hold() {
    std::vector<T> samples;
    samples.reserve(reserved_);
    visit([&](auto held) { samples.assign(held.begin(), held.end()); });
    samples_ = std::move(samples);
}

void RawValues::holdNarrowest() {
    if (canHold<uint8_t>(range_)) return hold<uint8_t>();
    if (canHold<int16_t>(range_)) return hold<int16_t>();
    if (canHold<uint16_t>(range_)) return hold<uint16_t>();
    hold<float>();
}

template <class T>
void RawValues::append(std::span<const T> samples) {
    const bool is_first = size() == 0;
    range_.include(rangeOf(samples));
    const bool fits = visit([&]<class Held>(std::span<const Held>) { return canHold<Held>(range_); });
    if (is_first && !std::is_same_v<T, float>)
        hold<T>();
    else if (is_first || !fits)
        holdNarrowest();
    std::visit([&](auto& held) { held.insert(held.end(), samples.begin(), samples.end()); }, samples_);
}

template <class T>
void RawValues::append(std::vector<T> samples) {
    if (size() > 0 || std::is_same_v<T, float>) return append(std::span<const T>(samples));
    range_ = rangeOf(std::span<const T>(samples));
    samples_ = std::move(samples);
}

template void RawValues::append(std::span<const uint8_t>);
template void RawValues::append(std::span<const int16_t>);
template void RawValues::append(std::span<const uint16_t>);
template void RawValues::append(std::span<const float>);
template void RawValues::append(std::vector<uint8_t>);
template void RawValues::append(std::vector<int16_t>);
template void RawValues::append(std::vector<uint16_t>);
template void RawValues::append(std::vector<float>);

void RawValues::reverseBlocks(size_t stride, size_t count) noexcept {
    std::visit(
        [&](auto& samples) {
            for (size_t group = 0; group + stride * count <= samples.size(); group += stride * count)
                for (size_t low = 0, high = count - 1; low < high; ++low, --high) {
                    const auto first = samples.begin() + ptrdiff_t(group + low * stride);
                    const auto last = samples.begin() + ptrdiff_t(group + high * stride);
                    std::swap_ranges(first, first + ptrdiff_t(stride), last);
                }
        },
        samples_);
}

void RawValues::setToLowest(size_t n) noexcept {
    std::visit([&]<class T>(std::vector<T>& samples) { samples[n] = T(range_.low); }, samples_);
}

void RawValues::forget(size_t begin, size_t end) noexcept {
    std::visit([&](auto& samples) { bonemill::forget(std::span(samples).subspan(begin, end - begin)); },
               samples_);
}

}  // namespace bonemill

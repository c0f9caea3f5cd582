// The samples of a scan are kept as narrow as they allow: a scan of 1024³ fills gigabytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <variant>
#include <vector>

namespace bonemill {

struct ValueRange {
    double low = std::numeric_limits<double>::infinity();  // lowest finite value; low > high: there is none
    double high = -std::numeric_limits<double>::infinity();
    bool are_integers = true;  // all finite values
    size_t non_finite = 0;

    void include(const ValueRange& other) noexcept;
};

// They are integers of 8 or 16 bit or floats, read as float whatever they are. It is for start-up only,
// and not RT-safe.
class RawValues {
  public:
    using Samples =
        std::variant<std::vector<uint8_t>, std::vector<int16_t>, std::vector<uint16_t>, std::vector<float>>;

    size_t size() const noexcept;
    size_t type() const noexcept { return samples_.index(); }  // index in Samples
    float operator[](size_t n) const noexcept;
    const ValueRange& range() const noexcept { return range_; }
    bool operator==(const RawValues& other) const noexcept;  // of the values, not of their type

    // Says before the first append how many will come, so that the first ones need not be moved.
    void reserve(size_t count) { reserved_ = count; }
    // T is any type of Samples. Integers keep their type and floats that are whole numbers become integers,
    // until a sample comes that needs more.
    template <class T>
    void append(std::span<const T> samples);
    // Takes integers over without a copy if they are the first.
    template <class T>
    void append(std::vector<T> samples);
    // Makes the last block the first in every group of `count` blocks of `stride` values.
    void reverseBlocks(size_t stride, size_t count) noexcept;
    // The value becomes the lowest finite one of all.
    void setToLowest(size_t n) noexcept;
    // Gives back the memory of the values begin .. end - 1, which no caller may read any more.
    void forget(size_t begin, size_t end) noexcept;

    // see(span of the samples as they are held): the fast way to read them all.
    template <class See>
    decltype(auto) visit(See&& see) const {
        return std::visit([&](const auto& samples) { return see(std::span(samples)); }, samples_);
    }

  private:
    template <class T>
    void hold();
    void holdNarrowest();

    Samples samples_;
    ValueRange range_;
    size_t reserved_ = 0;
};

}  // namespace bonemill

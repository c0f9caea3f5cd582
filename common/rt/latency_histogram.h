// Counts durations in fixed buckets, each at most 1 % wide from 100 ns to 10 s; they are log-linear, as
// HdrHistogram arranges them.
//
// record() is RT-safe, and the object (28 KiB) allocates nothing. One thread at a time may use it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace bonemill {

class LatencyHistogram {
  public:
    // Negative durations count as 0, and those above kLargestNs in the last bucket; maximum and
    // mean stay exact.
    void record(int64_t duration_ns) noexcept;
    void merge(const LatencyHistogram& other) noexcept;

    uint64_t count() const noexcept { return count_; }
    int64_t maxNs() const noexcept { return max_ns_; }
    double meanNs() const noexcept { return count_ ? double(sum_ns_) / double(count_) : 0.0; }

    // Returns the smallest duration that `percent` (0..100) of the records do not exceed, rounded up to its
    // bucket's end but never above maxNs(); 0 without records.
    int64_t percentileNs(double percent) const noexcept;

    static constexpr int64_t kLargestNs = 10'000'000'000;

  private:
    static constexpr int kSubBucketBits = 7;  // 128 buckets per octave: 1/128 < 1 %
    static constexpr size_t bucketOf(int64_t duration_ns) noexcept;
    static constexpr int64_t bucketEndNs(size_t bucket) noexcept;
    static constexpr size_t kBuckets = size_t(28) << kSubBucketBits;  // up to 2^34 ns > kLargestNs

    std::array<uint64_t, kBuckets> buckets_{};
    uint64_t count_ = 0;
    uint64_t sum_ns_ = 0;
    int64_t max_ns_ = 0;
};

}  // namespace bonemill

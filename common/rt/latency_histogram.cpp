#include "common/rt/latency_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace bonemill {

// Below 2^(kSubBucketBits + 1) ns each value has its own bucket; above, an octave 2^k .. 2^(k+1) is cut into
// 2^kSubBucketBits buckets of `1 << shift` ns.
constexpr size_t LatencyHistogram::bucketOf(int64_t duration_ns) noexcept {
    const int shift = std::max(0, int(std::bit_width(uint64_t(duration_ns))) - (kSubBucketBits + 1));
    return (size_t(shift) << kSubBucketBits) + size_t(duration_ns >> shift);
}

constexpr int64_t LatencyHistogram::bucketEndNs(size_t bucket) noexcept {
    if (bucket < size_t(2) << kSubBucketBits) return int64_t(bucket);
    const size_t shift = (bucket >> kSubBucketBits) - 1;
    return int64_t(((bucket - (shift << kSubBucketBits) + 1) << shift) - 1);
}

void LatencyHistogram::record(int64_t duration_ns) noexcept {
    static_assert(bucketOf(kLargestNs) < kBuckets);
    const int64_t duration = std::max<int64_t>(duration_ns, 0);
    ++buckets_[bucketOf(std::min(duration, kLargestNs))];
    ++count_;
    sum_ns_ += uint64_t(duration);
    max_ns_ = std::max(max_ns_, duration);
}

void LatencyHistogram::merge(const LatencyHistogram& other) noexcept {
    for (size_t i = 0; i < kBuckets; ++i) buckets_[i] += other.buckets_[i];
    count_ += other.count_;
    sum_ns_ += other.sum_ns_;
    max_ns_ = std::max(max_ns_, other.max_ns_);
}

int64_t LatencyHistogram::percentileNs(double percent) const noexcept {
    if (count_ == 0) return 0;
    const double fraction = std::clamp(percent, 0.0, 100.0) / 100.0;
    const uint64_t wanted = std::clamp<uint64_t>(uint64_t(std::ceil(fraction * double(count_))), 1, count_);
    if (wanted == count_) return max_ns_;
    uint64_t seen = 0;
    for (size_t i = 0; i < kBuckets; ++i) {
        seen += buckets_[i];
        if (seen >= wanted) return std::min(bucketEndNs(i), max_ns_);
    }
    return max_ns_;
}

}  // namespace bonemill

// Counts a scan's values, and finds the materials among them. For start-up only: it allocates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "haptic_server/core/volume/raw_values.h"

namespace bonemill {

// How often each value occurs: a scan is gone through once, however often it is asked. Only floats are gone
// through each time. The values must outlive it.
class ValueCounts {
  public:
    explicit ValueCounts(const RawValues& values);

    double total() const noexcept { return double(values_.size() - values_.range().non_finite); }  // finite
    // see(value, how often), also of those that are not finite.
    template <class See>
    void forEach(See&& see) const;

  private:
    template <class T>
    void count(std::span<const T> samples);

    const RawValues& values_;
    int first_ = 0;                 // value of counts_[0]
    std::vector<uint64_t> counts_;  // empty: floats
};

struct Histogram {
    double low = 0;
    double width = 1;
    std::vector<double> count;
    double total = 0;  // all finite values, also those outside the bins

    double centre(size_t bin) const { return low + (double(bin) + 0.5) * width; }
    double sumAbove(double value) const;  // of the bins that begin there or above
};

Histogram countInto(const ValueCounts& values, double low, double width, size_t bins);

// N bins, or a few less, from the lowest to the highest finite value.
Histogram histogramOfAll(const ValueCounts& values, const ValueRange& range, size_t bins);

// Some 256 bins over the range, zoomed in until the tails that are cut off hold next to nothing.
Histogram histogramOf(const ValueCounts& values, ValueRange range);

inline constexpr double kSmoothingBins = 2.0;
std::vector<double> smoothed(const std::vector<double>& count, double sigma_bins);

struct Mode {
    size_t bin;     // peak
    double height;  // of the smoothed histogram
    double mass;    // share of all voxels between the valleys around it
};

// Peaks of the smoothed histogram that are separated by real valleys and hold a real share of the voxels,
// ascending.
std::vector<Mode> modesOf(const Histogram& h);

// Peaks are read off more finely than a bin: centre of mass of the bins around it.
double peakValue(const Histogram& h, const Mode& mode);

// The threshold with the largest variance between the two classes (Otsu 1979).
double otsuThreshold(const Histogram& h);

template <class See>
void ValueCounts::forEach(See&& see) const {
    for (size_t n = 0; n < counts_.size(); ++n)
        if (counts_[n] > 0) see(double(first_ + int(n)), double(counts_[n]));
    if (!counts_.empty()) return;
    values_.visit([&](auto samples) {
        for (const double value : samples) see(value, 1.0);
    });
}

}  // namespace bonemill

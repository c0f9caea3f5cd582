#include "haptic_server/scans/find_bone/value_histogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "common/math/pinned_math.h"

namespace bonemill {

ValueCounts::ValueCounts(const RawValues& values) : values_(values) {
    values.visit([&]<class T>(std::span<const T> samples) {
        if constexpr (std::is_integral_v<T>) count(samples);
    });
}

template <class T>
void ValueCounts::count(std::span<const T> samples) {
    first_ = std::numeric_limits<T>::lowest();
    counts_.resize(size_t(std::numeric_limits<T>::max() - first_) + 1);
    // Neighbours are often alike: one after the other they are counted in turn, so that none waits.
    constexpr size_t kTurns = 4;
    std::vector<std::array<uint32_t, kTurns>> turns(counts_.size());
    for (size_t n = 0; n < samples.size(); ++n) ++turns[size_t(samples[n] - first_)][n % kTurns];
    for (size_t v = 0; v < counts_.size(); ++v)
        for (const uint32_t count : turns[v]) counts_[v] += count;
}

Histogram countInto(const ValueCounts& values, double low, double width, size_t bins) {
    Histogram h{low, width, std::vector<double>(bins, 0.0), values.total()};
    values.forEach([&](double value, double count) {
        const double bin = (value - low) / width;
        if (bin >= 0 && bin < double(bins)) h.count[size_t(bin)] += count;
    });
    return h;
}

namespace {

// Bins of integer data hold a whole number of values, or some would be empty and look like valleys.
Histogram binnedOver(const ValueCounts& values, double low, double high, bool are_integers, size_t bins) {
    double width = (high - low) / double(bins);
    if (are_integers) {
        width = std::max(1.0, std::ceil((high - low + 1) / double(bins)));
        low -= 0.5;
        bins = size_t((high - low) / width) + 1;
    } else {
        bins += 1;  // the highest value lies on the edge of the last bin
    }
    return countInto(values, low, width, bins);
}

constexpr size_t kBins = 256;
constexpr double kTail = 2e-4;  // share of values at each end that may be artefacts (metal, padding)

}  // namespace

Histogram histogramOfAll(const ValueCounts& values, const ValueRange& range, size_t bins) {
    return binnedOver(values, range.low, range.high, range.are_integers, bins);
}

Histogram histogramOf(const ValueCounts& values, ValueRange range) {
    for (int zoom = 0; zoom < 16; ++zoom) {
        const Histogram h = binnedOver(values, range.low, range.high, range.are_integers, kBins);
        size_t first = 0, last = h.count.size() - 1;
        for (double tail = 0; first < last && (tail += h.count[first]) <= kTail * h.total;) ++first;
        for (double tail = 0; last > first && (tail += h.count[last]) <= kTail * h.total;) --last;
        if (last + 1 - first > h.count.size() / 2) return h;
        const double low = h.low + double(first) * h.width, high = h.low + double(last + 1) * h.width;
        if (first == last && range.are_integers && h.width <= 1) return h;
        if (!(high - low < 0.9 * (range.high - range.low))) return h;
        range.low = range.are_integers ? std::ceil(low) : low;
        range.high = range.are_integers ? std::floor(high) : high;
    }
    return binnedOver(values, range.low, range.high, range.are_integers, kBins);
}

std::vector<double> smoothed(const std::vector<double>& count, double sigma_bins) {
    const int reach = int(std::ceil(3 * sigma_bins));
    std::vector<double> out(count.size(), 0.0);
    for (int b = 0; b < int(count.size()); ++b) {
        double weights = 0;
        for (int d = -reach; d <= reach; ++d) {
            if (b + d < 0 || b + d >= int(count.size())) continue;
            const double w = pinned::exp(-0.5 * d * d / (sigma_bins * sigma_bins));
            out[size_t(b)] += w * count[size_t(b + d)];
            weights += w;
        }
        out[size_t(b)] /= weights;
    }
    return out;
}

std::vector<Mode> modesOf(const Histogram& h) {
    constexpr double kValleyRatio = 0.6;  // a valley must fall below this share of the lower of its two peaks
    constexpr double kMinMass = 0.005;    // and a material must hold this share of the voxels
    const std::vector<double> s = smoothed(h.count, kSmoothingBins);
    std::vector<size_t> peaks;
    size_t valley = 0;  // lowest bin since the last accepted peak
    for (size_t b = 0; b < s.size(); ++b) {
        if (!peaks.empty() && s[b] < s[valley]) valley = b;
        const bool is_peak =
            s[b] > 0 && (b == 0 || s[b] > s[b - 1]) && (b + 1 == s.size() || s[b] >= s[b + 1]);
        if (!is_peak) continue;
        if (!peaks.empty() && s[valley] > kValleyRatio * std::min(s[peaks.back()], s[b])) {
            if (s[b] <= s[peaks.back()]) continue;  // a shoulder of the last peak
            peaks.pop_back();                       // the last one was a shoulder of this
        }
        peaks.push_back(b);
        valley = b;
    }
    std::vector<Mode> modes;
    for (size_t p = 0; p < peaks.size(); ++p) {
        const auto lowest = [&](size_t from, size_t to) {
            return size_t(std::min_element(s.begin() + ptrdiff_t(from), s.begin() + ptrdiff_t(to)) -
                          s.begin());
        };
        const size_t begin = p == 0 ? 0 : lowest(peaks[p - 1], peaks[p]);
        const size_t end = p + 1 == peaks.size() ? s.size() : lowest(peaks[p], peaks[p + 1]);
        double mass = 0;
        for (size_t b = begin; b < end; ++b) mass += h.count[b];
        mass /= h.total;
        if (mass >= kMinMass) modes.push_back({peaks[p], s[peaks[p]], mass});
    }
    return modes;
}

double peakValue(const Histogram& h, const Mode& mode) {
    double weight = 0, sum = 0;
    const size_t reach = size_t(kSmoothingBins);
    for (size_t b = mode.bin - std::min(mode.bin, reach); b < std::min(h.count.size(), mode.bin + reach + 1);
         ++b) {
        weight += h.count[b];
        sum += h.count[b] * h.centre(b);
    }
    return weight > 0 ? sum / weight : h.centre(mode.bin);
}

double otsuThreshold(const Histogram& h) {
    double total = 0, total_moment = 0;
    for (size_t b = 0; b < h.count.size(); ++b) {
        total += h.count[b];
        total_moment += h.count[b] * h.centre(b);
    }
    double below = 0, below_moment = 0, best = -1, threshold = h.centre(h.count.size() / 2);
    for (size_t b = 0; b + 1 < h.count.size(); ++b) {
        below += h.count[b];
        below_moment += h.count[b] * h.centre(b);
        if (below == 0 || below == total) continue;
        const double gap = below_moment / below - (total_moment - below_moment) / (total - below);
        const double between = below * (total - below) * gap * gap;
        if (between > best) {
            best = between;
            threshold = h.centre(b) + h.width / 2;
        }
    }
    return threshold;
}

double Histogram::sumAbove(double value) const {
    double sum = 0;
    for (size_t b = 0; b < count.size(); ++b)
        if (low + double(b) * width >= value) sum += count[b];
    return sum;
}

}  // namespace bonemill

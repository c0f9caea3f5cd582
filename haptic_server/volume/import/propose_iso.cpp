#include "haptic_server/volume/import/propose_iso.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "common/math/pinned_math.h"
#include "common/user_error.h"

namespace bonemill {
namespace {

struct Histogram {
    double low = 0;
    double width = 1;
    std::vector<double> count;
    double total = 0;  // all finite values, also those outside the bins

    double centre(size_t bin) const { return low + (double(bin) + 0.5) * width; }
};

Histogram countInto(const RawValues& values, double low, double width, size_t bins) {
    Histogram h{low, width, std::vector<double>(bins, 0.0), 0.0};
    h.total = double(values.size() - values.range().non_finite);
    values.visit([&](auto samples) {
        for (const double v : samples) {
            const double bin = (v - low) / width;
            if (bin >= 0 && bin < double(bins)) h.count[size_t(bin)] += 1;
        }
    });
    return h;
}

// Bins of integer data hold a whole number of values, or some would be empty and look like valleys.
Histogram binnedOver(const RawValues& values, double low, double high, bool are_integers, size_t bins) {
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

// Zooms in until the tails that are cut off hold no more than kTail of the values each.
Histogram histogramOf(const RawValues& values, ValueRange range) {
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

constexpr double kSmoothingBins = 2.0;
constexpr double kValleyRatio = 0.6;  // a valley must fall below this share of the lower of its two peaks
constexpr double kLeastMass = 0.005;  // and a material must hold this share of the voxels

struct Mode {
    size_t bin;     // peak
    double height;  // of the smoothed histogram
    double mass;    // share of all voxels between the valleys around it
};

// Finds peaks of the smoothed histogram that are separated by real valleys and hold a real share
// of the voxels.
std::vector<Mode> modesOf(const Histogram& h) {
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
        if (mass >= kLeastMass) modes.push_back({peaks[p], s[peaks[p]], mass});
    }
    return modes;
}

// Peaks are read off more finely than a bin: centre of mass of the bins around it.
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

// Chooses the threshold with the largest variance between the two classes (Otsu 1979).
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

// Only CT in Hounsfield units has such values: air is at -1000.
constexpr double kSurelyAirHu = -500;
constexpr double kExportShift = 1024;  // exports that store HU + 1024 and forget the intercept

// Finds the raw value of 0 HU when the values are Hounsfield units, shifted or not.
std::optional<double> waterValue(const RawVolume& raw, const ValueRange& range, const Histogram& h,
                                 const std::vector<Mode>& modes) {
    if (raw.is_hounsfield || range.low <= kSurelyAirHu) return 0.0;
    bool has_air = false, has_soft_tissue = false;
    for (const Mode& mode : modes) {
        const double value = peakValue(h, mode);
        has_air = has_air || (value >= -50 && value <= 150);
        has_soft_tissue = has_soft_tissue || (value >= 950 && value <= 1150);
    }
    if (has_air && has_soft_tissue && range.high > 1300) return kExportShift;
    return std::nullopt;
}

constexpr double kSoftTissueBinHu = 5;
constexpr double kSoftTissueLowHu = -50;  // fat lies below: its peak would hide the width of muscle and brain
constexpr double kSoftTissueHighHu = 150;
constexpr double kHighestHu = 4000;  // metal beyond
constexpr double kLeastSoftTissue = 0.01;
constexpr double kBoneLowHu = 200;   // noise and contrast agent below
constexpr double kBoneHighHu = 300;  // thin cortical walls vanish above
constexpr double kNoiseSigmas = 3;

// Finds the upper edge of the noise of soft tissue: its peak, and sigma from the half width on the
// side of bone.
double noiseEdge(const Histogram& h, size_t peak) {
    constexpr double kHalfWidthOfSigma = 1.17741;  // sqrt(2 ln 2)
    size_t half = peak;
    while (half + 1 < h.count.size() && h.count[half] > h.count[peak] / 2) ++half;
    return h.centre(peak) + kNoiseSigmas * double(half - peak) * h.width / kHalfWidthOfSigma;
}

double medianAbove(const Histogram& h, double value) {
    const auto first = size_t(std::clamp((value - h.low) / h.width, 0.0, double(h.count.size() - 1)));
    double total = 0, sum = 0;
    for (size_t b = first; b < h.count.size(); ++b) total += h.count[b];
    for (size_t b = first; b < h.count.size(); ++b)
        if ((sum += h.count[b]) >= total / 2) return h.centre(b);
    return value;
}

// Goes half-way from soft tissue to bone, in HU; there is nothing when the scan holds no soft tissue.
std::optional<double> halfWayFromSoftTissue(const RawValues& values, double water) {
    const auto bins = size_t((kHighestHu - kSoftTissueLowHu) / kSoftTissueBinHu);
    Histogram h = countInto(values, water + kSoftTissueLowHu, kSoftTissueBinHu, bins);
    h.low -= water;
    h.count = smoothed(h.count, kSmoothingBins);
    const auto tissue_end =
        h.count.begin() + ptrdiff_t((kSoftTissueHighHu - kSoftTissueLowHu) / kSoftTissueBinHu);
    if (std::accumulate(h.count.begin(), tissue_end, 0.0) < kLeastSoftTissue * h.total) return std::nullopt;
    const auto peak = size_t(std::max_element(h.count.begin(), tissue_end) - h.count.begin());
    const double bone = medianAbove(h, std::max(noiseEdge(h, peak), kBoneLowHu));
    return (h.centre(peak) + bone) / 2;
}

constexpr double kLeastMaterialShare =
    0.15;  // of all that is denser than the background; less is an edge or a cavity

// The background is the material with the most voxels.
std::optional<double> halfWayAboveBackground(const Histogram& h, const std::vector<Mode>& modes) {
    const auto background = std::max_element(modes.begin(), modes.end(),
                                             [](const Mode& a, const Mode& b) { return a.mass < b.mass; });
    double mass_above = 0;
    for (auto mode = background; mode != modes.end(); ++mode)
        mass_above += mode == background ? 0 : mode->mass;
    for (auto mode = background; mode != modes.end(); ++mode)
        if (mode != background && mode->mass >= kLeastMaterialShare * mass_above)
            return (peakValue(h, *background) + peakValue(h, *mode)) / 2;
    return std::nullopt;
}

}  // namespace

double proposeIsoValue(const RawVolume& raw) {
    const ValueRange& range = raw.values.range();
    if (!(range.low < range.high))
        throw UserError("no iso-value can be proposed: all values of the volume are alike (" +
                        raw.description + ")");
    const Histogram h = histogramOf(raw.values, range);
    const std::vector<Mode> modes = modesOf(h);
    if (const auto water = waterValue(raw, range, h, modes))
        if (const auto half_way = halfWayFromSoftTissue(raw.values, *water))
            return *water + std::clamp(*half_way, kBoneLowHu, kBoneHighHu);
    if (const auto half_way = halfWayAboveBackground(h, modes)) return *half_way;
    return otsuThreshold(h);
}

}  // namespace bonemill

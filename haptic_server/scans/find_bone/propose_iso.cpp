#include "haptic_server/scans/find_bone/propose_iso.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/find_bone/value_histogram.h"

namespace bonemill {
namespace {

constexpr double kMinRise = 0.5;  // of the way from the higher end to the iso-value: noise rises less

double meanAbove(std::span<const float> samples, double iso) {
    double sum = 0, count = 0;
    for (const auto sample : samples)
        if (const auto value = double(sample); std::isfinite(value) && value >= iso) sum += value, ++count;
    return count > 0 ? sum / count : iso;
}

// Whole numbers are added without rounding, in any order.
template <class Integer>
double meanAbove(std::span<const Integer> samples, double iso) {
    const double least = std::ceil(iso);
    if (!(least <= double(std::numeric_limits<Integer>::max()))) return iso;
    const int first = int(std::max(least, double(std::numeric_limits<Integer>::lowest())));
    int64_t sum = 0, count = 0;
    for (const Integer sample : samples) {
        const bool is_above = sample >= first;
        sum += is_above ? sample : 0;
        count += is_above;
    }
    return count > 0 ? double(sum) / double(count) : iso;
}

// In voxels along the axis; 0: it is none.
template <class Samples>
double wallAt(Samples samples, size_t at, size_t stride, double iso, double bone) {
    std::array<double, 5> v{};
    for (size_t n = 0; n < 5; ++n) v[n] = double(samples[at + n * stride - 2 * stride]);
    const double base = std::max(v[0], v[4]);
    if (!(v[2] > v[1] && v[2] > v[3] && v[2] < iso && v[2] - base >= kMinRise * (iso - base))) return 0;
    double sum = 0;
    for (const double value : v) sum += std::max(0.0, value - base);
    return sum / (bone - base);
}

// Only CT in Hounsfield units has such values: air is at -1000.
constexpr double kSurelyAirHu = -500;
constexpr double kExportShift = 1024;  // exports that store HU + 1024 and forget the intercept

bool isSurelyHounsfield(const RawVolume& raw) {
    return raw.is_hounsfield || raw.values.range().low <= kSurelyAirHu;
}

std::optional<double> waterValueOf(const RawVolume& raw, const Histogram& h, const std::vector<Mode>& modes) {
    if (isSurelyHounsfield(raw)) return 0.0;
    bool has_air = false, has_soft_tissue = false;
    for (const Mode& mode : modes) {
        const double value = peakValue(h, mode);
        has_air = has_air || (value >= -50 && value <= 150);
        has_soft_tissue = has_soft_tissue || (value >= 950 && value <= 1150);
    }
    if (has_air && has_soft_tissue && raw.values.range().high > 1300) return kExportShift;
    return std::nullopt;
}

constexpr double kSoftTissueBinHu = 5;
constexpr double kSoftTissueLowHu = -50;  // fat lies below: its peak would hide the width of muscle and brain
constexpr double kSoftTissueHighHu = 150;
constexpr double kHighestHu = 4000;  // metal beyond
constexpr double kMinSoftTissue = 0.01;
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
std::optional<double> halfWayFromSoftTissue(const ValueCounts& values, double water) {
    const auto bins = size_t((kHighestHu - kSoftTissueLowHu) / kSoftTissueBinHu);
    Histogram h = countInto(values, water + kSoftTissueLowHu, kSoftTissueBinHu, bins);
    h.low -= water;
    h.count = smoothed(h.count, kSmoothingBins);
    const auto tissue_end =
        h.count.begin() + ptrdiff_t((kSoftTissueHighHu - kSoftTissueLowHu) / kSoftTissueBinHu);
    if (std::accumulate(h.count.begin(), tissue_end, 0.0) < kMinSoftTissue * h.total) return std::nullopt;
    const auto peak = size_t(std::max_element(h.count.begin(), tissue_end) - h.count.begin());
    const double bone = medianAbove(h, std::max(noiseEdge(h, peak), kBoneLowHu));
    return (h.centre(peak) + bone) / 2;
}

constexpr double kMinMaterialShare =
    0.15;  // of all that is denser than the background; less is an edge or a cavity

// The background is the material with the most voxels.
std::optional<double> halfWayAboveBackground(const Histogram& h, const std::vector<Mode>& modes) {
    const auto background = std::max_element(modes.begin(), modes.end(),
                                             [](const Mode& a, const Mode& b) { return a.mass < b.mass; });
    double mass_above = 0;
    for (auto mode = background; mode != modes.end(); ++mode)
        mass_above += mode == background ? 0 : mode->mass;
    for (auto mode = background; mode != modes.end(); ++mode)
        if (mode != background && mode->mass >= kMinMaterialShare * mass_above)
            return (peakValue(h, *background) + peakValue(h, *mode)) / 2;
    return std::nullopt;
}

// Of a scan whose scale is not known: what is far denser than the main material above air, and of many
// densities, is bone in soft tissue; enamel above dentine is of one. With air at -1000 HU and soft tissue at
// 40, kBoneHighHu lies a quarter of the way further.
constexpr double kBoneAboveTissue = 0.25, kMinSpread = 0.6;  // of the way from the background to the tissue
constexpr double kAirQuantile = 0.01;
constexpr double kMinTail = 0.003, kMaxTail = 0.5;  // of the tissue's voxels

// The value below which that share of what lies above `from` is.
double quantileAbove(const Histogram& h, double from, double share) {
    double rest = share * h.sumAbove(from);
    for (size_t b = 0; b < h.count.size(); ++b)
        if (h.low + double(b) * h.width >= from && (rest -= h.count[b]) <= 0) return h.centre(b);
    return h.centre(h.count.size() - 1);
}

std::optional<double> boneAbove(const Histogram& h, double air, double tissue, double tissue_share) {
    const double bone = tissue + kBoneAboveTissue * (tissue - air);
    const double share = h.sumAbove(bone) / (tissue_share * h.total);
    if (share < kMinTail || share > kMaxTail) return std::nullopt;
    const double spread = quantileAbove(h, bone, 0.9) - quantileAbove(h, bone, 0.1);
    return spread >= kMinSpread * (tissue - air) ? std::optional(bone) : std::nullopt;
}

// Bone denser than the scale goes piles up at its end, where it looks like a material. It is none if more of
// it lies on the way there. That can only be said where air is seen, about as far below tissue: a scale that
// is cut off at both ends says nothing.
bool isLastCutOff(const Histogram& h, const std::vector<Mode>& modes) {
    constexpr double kAirBelow = 0.8;  // of the way from tissue to the end
    if (modes.size() < 3 || modes.back().bin + 1 != h.count.size()) return false;
    const double tissue = peakValue(h, modes[modes.size() - 2]), end = h.centre(modes.back().bin);
    if (tissue - peakValue(h, modes.front()) < kAirBelow * (end - tissue)) return false;
    const double heap = h.count.back();
    return h.sumAbove(tissue + kBoneAboveTissue * (end - tissue)) - heap > heap;
}

// Of a scan of the trunk most is soft tissue, and air is no material of its own.
std::optional<double> boneAboveTissue(const Histogram& h, std::vector<Mode> modes) {
    if (isLastCutOff(h, modes)) modes.pop_back();
    const auto background = std::ranges::max_element(modes, {}, &Mode::mass);
    const auto above = std::ranges::max_element(background + 1, modes.end(), {}, &Mode::mass);
    if (above != modes.end())
        return boneAbove(h, peakValue(h, *background), peakValue(h, *above), above->mass);
    const double air =
        background == modes.begin() ? quantileAbove(h, h.low, kAirQuantile) : peakValue(h, modes.front());
    return boneAbove(h, air, peakValue(h, *background), background->mass);
}

IsoProposal ofUnknownScale(const Histogram& h, const std::vector<Mode>& modes) {
    const auto half_way = halfWayAboveBackground(h, modes);
    if (modes.empty())
        return {otsuThreshold(h), IsoDoubt::kLarge, {}, "no material stands out: Otsu's threshold"};
    if (const auto bone = boneAboveTissue(h, modes))
        return {*bone, IsoDoubt::kLarge, half_way,
                "what lies above what looks like soft tissue, on an unknown scale"};
    if (half_way) {
        const bool are_more = modes.size() > 2;
        const double other =
            are_more ? (peakValue(h, modes[modes.size() - 2]) + peakValue(h, modes.back())) / 2 : *half_way;
        return {*half_way, are_more ? IsoDoubt::kSome : IsoDoubt::kLittle,
                other == *half_way ? std::nullopt : std::optional(other),
                "half-way from the background to the next denser material"};
    }
    return {otsuThreshold(h), IsoDoubt::kLarge, std::nullopt, "no material stands out: Otsu's threshold"};
}

IsoProposal proposal(const RawVolume& raw, const ValueCounts& values) {
    const ValueRange& range = raw.values.range();
    if (!(range.low < range.high))
        throw UserError("no iso-value can be proposed: all values of the volume are alike (" +
                        raw.description + ")");
    const Histogram h = histogramOf(values, range);
    const std::vector<Mode> modes = modesOf(h);
    const auto water = waterValueOf(raw, h, modes);
    if (!water) return ofUnknownScale(h, modes);
    const auto half_way = halfWayFromSoftTissue(values, *water);
    if (!half_way) return ofUnknownScale(h, modes);
    const double value = *water + std::clamp(*half_way, kBoneLowHu, kBoneHighHu);
    const double other = *water + *half_way;
    const std::string scale = *water == 0 ? "Hounsfield units" : "Hounsfield units shifted by 1024";
    return {value, *water == 0 ? IsoDoubt::kLittle : IsoDoubt::kSome,
            other == value ? std::nullopt : std::optional(other),
            scale + ": half-way from soft tissue to bone, within 200 .. 300 HU"};
}

constexpr double kMinBone = 5e-4, kMaxBone = 0.6;  // of the voxels

double shareAbove(const ValueCounts& values, double iso) {
    double above = 0;
    values.forEach([&](double value, double count) { above += value >= iso ? count : 0; });
    return above / values.total();
}

}  // namespace

ThinWalls findThinWalls(const RawVolume& scan, const IndexBox& within, double iso_value) {
    const Eigen::Vector3i& dims = scan.geometry.dims;
    const std::array<size_t, 3> stride = {1, size_t(dims.x()), size_t(dims.x()) * size_t(dims.y())};
    std::vector<float> found;
    scan.values.visit([&](auto samples) {
        const double bone = meanAbove(samples, iso_value);
        forEachIndex(within, [&](const Eigen::Vector3i& v) {
            const size_t at = size_t(v.x()) + stride[1] * size_t(v.y()) + stride[2] * size_t(v.z());
            if (!(double(samples[at]) < iso_value)) return;
            double thinnest = 0;
            for (int axis = 0; axis < 3; ++axis) {
                if (v[axis] < 2 || v[axis] + 2 >= dims[axis]) continue;
                const double wall =
                    scan.geometry.spacing[axis] * wallAt(samples, at, stride[size_t(axis)], iso_value, bone);
                if (wall > 0 && (thinnest == 0 || wall < thinnest)) thinnest = wall;
            }
            if (thinnest > 0) found.push_back(float(thinnest));
        });
    });
    ThinWalls walls{.voxels = found.size()};
    if (found.empty()) return walls;
    const auto middle = found.begin() + ptrdiff_t(found.size() / 2);
    std::nth_element(found.begin(), middle, found.end());
    walls.median_thickness = double(*middle);
    return walls;
}

std::optional<double> waterValue(const RawVolume& raw) {
    if (isSurelyHounsfield(raw)) return 0.0;
    const Histogram h = histogramOf(ValueCounts(raw.values), raw.values.range());
    return waterValueOf(raw, h, modesOf(h));
}

IsoProposal proposeIso(const RawVolume& raw) {
    const ValueCounts values(raw.values);
    IsoProposal proposed = proposal(raw, values);
    proposed.bone_share = shareAbove(values, proposed.value);
    return proposed;
}

const char* wordOf(IsoDoubt doubt) {
    const char* const words[] = {"sure", "not quite sure", "a guess"};
    return words[size_t(doubt)];
}

std::string textOf(const IsoProposal& proposed) {
    std::string all = printed("%.6g proposed (%s; %.3g %% of the voxels lie above; ", proposed.value,
                              wordOf(proposed.doubt), 100 * proposed.bone_share) +
                      proposed.why + ")";
    if (proposed.runner_up) all += printed("; the next best is %.6g", *proposed.runner_up);
    if (proposed.bone_share < kMinBone) all += "; that is hardly any: there may be no bone in this scan";
    if (proposed.bone_share > kMaxBone)
        all += "; that is so much that it may not be bone: look at it, and set volume.iso_value";
    return all;
}

}  // namespace bonemill

#include "haptic_server/scans/dicom/segment_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

constexpr double kSameSliceMm = 1e-3;
constexpr double kMaxOffStep = 0.1;   // of a step: scanners round
constexpr double kMaxOffPlace = 0.2;  // of a step: the offs of many steps do not add up
constexpr int kMaxSegmentSlices = 8192;
constexpr double kMaxTilt = 1;  // sideways per way along the normal: 45 degrees
constexpr double kMaxAsidePixels = 16384;

[[noreturn]] void refuseFrames(const std::string& file, const std::string& why) {
    throw UserError(file + ": " + why + kWayOverSlicer);
}

struct Offset {
    double along;           // mm along the normal
    Eigen::Vector2d aside;  // pixels along the row and the column
};

std::vector<Offset> offsetsOf(const std::vector<DicomPlace>& frames, const std::string& file) {
    constexpr double kMostTurn = 1e-3, kMaxPixelDifference = 1e-4;  // mm
    const DicomPlace& first = frames.front();
    const Eigen::Vector3d normal = first.row_direction.cross(first.column_direction);
    std::vector<Offset> offsets;
    for (const DicomPlace& frame : frames) {
        if ((frame.row_direction - first.row_direction).cwiseAbs().maxCoeff() > kMostTurn ||
            (frame.column_direction - first.column_direction).cwiseAbs().maxCoeff() > kMostTurn)
            refuseFrames(file, "its frames lie in several directions");
        if ((frame.pixel_spacing_mm - first.pixel_spacing_mm).cwiseAbs().maxCoeff() > kMaxPixelDifference)
            refuseFrames(file, "its frames have pixels of several sizes");
        const Eigen::Vector3d way = frame.position_mm - first.position_mm;
        offsets.push_back(
            {way.dot(normal), Eigen::Vector2d(way.dot(first.row_direction), way.dot(first.column_direction))
                                  .cwiseQuotient(first.pixel_spacing_mm)});
    }
    return offsets;
}

// Ascending, each slice once.
std::vector<double> slicesAlong(const std::vector<Offset>& offsets) {
    std::vector<double> all;
    for (const Offset& offset : offsets) all.push_back(offset.along);
    std::ranges::sort(all);
    std::vector<double> slices;
    for (const double along : all)
        if (slices.empty() || along - slices.back() > kSameSliceMm) slices.push_back(along);
    return slices;
}

struct SliceStack {
    std::vector<int> counts;  // of steps from the first slice to each
    double step;
};

// Whether each slice is where that number of even steps leads to.
bool isEven(const SliceStack& stack, const std::vector<double>& slices) {
    for (size_t n = 0; n < slices.size(); ++n)
        if (std::abs((slices[n] - slices.front()) / stack.step - stack.counts[n]) > kMaxOffPlace)
            return false;
    return true;
}

// Nothing if the slices do not fit a step of about that length.
std::optional<SliceStack> stackOfStep(const std::vector<double>& slices, double step) {
    std::vector<int> counts{0};
    for (size_t n = 1; n < slices.size(); ++n) {
        const double gap = (slices[n] - slices[n - 1]) / step, whole = std::max(1.0, std::round(gap));
        if (!(std::abs(gap - whole) <= kMaxOffStep && whole < kMaxSegmentSlices)) return std::nullopt;
        counts.push_back(counts.back() + int(whole));
        if (counts.back() >= kMaxSegmentSlices) return std::nullopt;
    }
    const int all = counts.back();
    SliceStack stack{std::move(counts), all > 0 ? (slices.back() - slices.front()) / all : step};
    return isEven(stack, slices) ? std::optional(std::move(stack)) : std::nullopt;
}

SliceStack sliceStackOf(const std::vector<double>& slices, const SliceSteps& steps, const std::string& file) {
    std::vector<double> choices;
    if (steps.between && *steps.between > kSameSliceMm) choices.push_back(*steps.between);
    double smallest = std::numeric_limits<double>::infinity();
    for (size_t n = 1; n < slices.size(); ++n) smallest = std::min(smallest, slices[n] - slices[n - 1]);
    if (slices.size() > 1) choices.push_back(smallest);
    if (steps.thickness && *steps.thickness > kSameSliceMm) choices.push_back(*steps.thickness);
    if (choices.empty())
        refuseFrames(file, "holds one slice, and does not say how far it is to the next one");
    for (const double step : choices)
        if (auto stack = stackOfStep(slices, step)) return std::move(*stack);
    refuseFrames(file, "its slices are unevenly far apart, or more than " +
                           std::to_string(kMaxSegmentSlices) +
                           " steps (smallest: " + printed("%.4g", smallest) + " mm)");
}

void checkAside(const std::vector<Offset>& offsets, const Eigen::Vector2d& pixel_mm,
                const std::string& file) {
    for (const Offset& offset : offsets) {
        const double aside = offset.aside.cwiseProduct(pixel_mm).cwiseAbs().maxCoeff();
        if (!(aside <= kMaxTilt * std::abs(offset.along) + pixel_mm.maxCoeff()) ||
            !(offset.aside.cwiseAbs().maxCoeff() <= kMaxAsidePixels))
            refuseFrames(file, "its frames lie " + printed("%.4g", aside) + " mm beside each other");
    }
}

}  // namespace

SegmentGrid segmentGridOf(const std::vector<DicomPlace>& frames, const Eigen::Vector2i& size,
                          const SliceSteps& steps, const std::string& file) {
    const DicomPlace& first = frames.front();
    const std::vector<Offset> offsets = offsetsOf(frames, file);
    checkAside(offsets, first.pixel_spacing_mm, file);
    const std::vector<double> slices = slicesAlong(offsets);
    const SliceStack stack = sliceStackOf(slices, steps, file);
    SegmentGrid grid;
    Eigen::Vector2i low = Eigen::Vector2i::Zero(), high = low;
    for (const Offset& offset : offsets) {
        // The last one that is not behind it is what it was taken for.
        const auto slice = std::ranges::upper_bound(slices, offset.along) - slices.begin() - 1;
        const Eigen::Vector2i aside = offset.aside.array().round().cast<int>();
        grid.places.push_back({stack.counts[size_t(slice)], aside});
        low = low.cwiseMin(aside);
        high = high.cwiseMax(aside);
        const Eigen::Vector2d off =
            (offset.aside - aside.cast<double>()).cwiseProduct(first.pixel_spacing_mm);
        grid.aside_mm = std::max(grid.aside_mm, off.norm());
    }
    for (SegmentGrid::Place& place : grid.places) place.first -= low;
    const Eigen::Vector2i edge = size + high - low;
    grid.frame.dims = {edge.x(), edge.y(), std::max(2, stack.counts.back() + 1)};
    grid.frame.spacing_mm = {first.pixel_spacing_mm.x(), first.pixel_spacing_mm.y(), stack.step};
    const Eigen::Vector3d normal = first.row_direction.cross(first.column_direction);
    grid.frame.directions << first.row_direction, first.column_direction, normal;
    grid.frame.origin_mm = first.position_mm + slices.front() * normal +
                           low.x() * first.pixel_spacing_mm.x() * first.row_direction +
                           low.y() * first.pixel_spacing_mm.y() * first.column_direction;
    return grid;
}

}  // namespace bonemill

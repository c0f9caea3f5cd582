#include "haptic_server/volume/import/dicom_series.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <tuple>

#include "common/math/pinned_math.h"
#include "common/units.h"
#include "common/user_error.h"

namespace bonemill {
namespace {

// Headers carry decimal text; these steps are coarser than its rounding and finer than any real difference.
constexpr double kDirectionStep = 1e-3;
constexpr double kPixelSpacingStepMm = 1e-4;
constexpr double kSamePlaceMm = 1e-3;
constexpr double kSpacingTolerance = 0.02;  // of the median distance
constexpr double kSpacingToleranceMm = 2e-3;
constexpr double kMaxTiltDegrees = 0.1;

using GroupKey = std::tuple<std::string, std::vector<long>, int, int>;

GroupKey groupKey(const DicomSlice& slice) {
    std::vector<long> numbers;
    for (const auto& direction : {slice.row_direction, slice.column_direction})
        for (const double d : direction) numbers.push_back(std::lround(d / kDirectionStep));
    for (const double s : slice.pixel_spacing_mm) numbers.push_back(std::lround(s / kPixelSpacingStepMm));
    return {slice.series_uid, numbers, slice.columns, slice.rows};
}

using Groups = std::map<GroupKey, std::vector<DicomSlice>>;

std::string describe(const std::vector<DicomSlice>& group) {
    const DicomSlice& first = group.front();
    return std::to_string(group.size()) + " slices " + std::to_string(first.columns) + "x" +
           std::to_string(first.rows) + " of series " + first.series_uid +
           (first.series_description.empty() ? "" : " (" + first.series_description + ")");
}

std::string listOf(const Groups& groups) {
    constexpr size_t kMostListed = 8;
    std::string text;
    size_t listed = 0;
    for (const auto& [key, group] : groups) {
        if (listed++ == kMostListed) return text + "; ...";
        text += (text.empty() ? "" : "; ") + describe(group);
    }
    return text;
}

std::string nameOf(const DicomSlice& slice) {
    const std::string file = slice.path.filename().string();
    return slice.frame == 0 ? file : file + " frame " + std::to_string(slice.frame + 1);
}

std::string nameAndPlace(const DicomSlice& slice, double place_mm) {
    char place[48];
    std::snprintf(place, sizeof place, " at %.3f mm", place_mm);
    return nameOf(slice) + place;
}

double placeAlongNormal(const DicomSlice& slice, const Eigen::Vector3d& normal) {
    return normal.dot(slice.position_mm);
}

void checkDistances(const std::vector<DicomSlice>& slices, const std::vector<double>& places,
                    const std::string& folder) {
    std::vector<double> distances;
    for (size_t s = 1; s < slices.size(); ++s) distances.push_back(places[s] - places[s - 1]);
    std::vector<double> sorted = distances;
    std::sort(sorted.begin(), sorted.end());
    for (size_t s = 1; s < slices.size(); ++s)
        if (distances[s - 1] < kSamePlaceMm)
            throw UserError(
                folder + ": two slices lie at the same place: " + nameAndPlace(slices[s - 1], places[s - 1]) +
                " and " + nameAndPlace(slices[s], places[s]) +
                "; remove the duplicates or name one series_uid");
    const double median = sorted[sorted.size() / 2];
    for (size_t s = 1; s < slices.size(); ++s) {
        const double excess = distances[s - 1] - median;
        if (std::abs(excess) <= std::max(kSpacingTolerance * median, kSpacingToleranceMm)) continue;
        const double missing = distances[s - 1] / median - 1;
        const bool are_whole = missing > 0.5 && std::abs(missing - std::round(missing)) < 0.1;
        char text[96];
        std::snprintf(text, sizeof text, are_whole ? "%.0f slice(s) missing" : "uneven slice spacing",
                      missing);
        char rest[96];
        std::snprintf(rest, sizeof rest, " (%.4g mm apart, the others %.4g mm)", distances[s - 1], median);
        throw UserError(folder + ": " + text + " between " + nameAndPlace(slices[s - 1], places[s - 1]) +
                        " and " + nameAndPlace(slices[s], places[s]) + rest + "; complete the series");
    }
}

void checkTilt(const std::vector<DicomSlice>& slices, const Eigen::Vector3d& normal,
               const std::string& folder) {
    const Eigen::Vector3d along = slices.back().position_mm - slices.front().position_mm;
    const double tilt_degrees = pinned::atan2(along.cross(normal).norm(), along.dot(normal)) / kDegree;
    const Eigen::Vector3d step = along / double(slices.size() - 1);
    for (size_t s = 1; s < slices.size(); ++s) {
        const Eigen::Vector3d off = slices[s].position_mm - slices[0].position_mm - step * double(s);
        const double aside = (off - normal * normal.dot(off)).norm();
        if (aside > 0.1 * slices[0].pixel_spacing_mm.minCoeff())
            throw UserError(
                folder + ": " + nameOf(slices[s]) +
                " is shifted sideways against the other slices; the series is not one straight stack");
    }
    if (tilt_degrees <= kMaxTiltDegrees) return;
    char text[160];
    std::snprintf(text, sizeof text,
                  "the gantry was tilted: slices are stacked %.2f degrees off their normal (%s to %s)",
                  tilt_degrees, slices.front().path.filename().c_str(),
                  slices.back().path.filename().c_str());
    throw UserError(folder + ": " + text + "; resample the series to a rectangular grid first");
}

}  // namespace

DicomStack chooseStack(const std::vector<DicomSlice>& slices, const std::string& series_uid,
                       const std::string& folder) {
    Groups groups, wanted;
    for (const DicomSlice& slice : slices) groups[groupKey(slice)].push_back(slice);
    for (const auto& [key, group] : groups)
        if (series_uid.empty() || group.front().series_uid == series_uid) wanted[key] = group;
    if (wanted.empty())
        throw UserError(folder + ": holds no series " + series_uid + "; it holds " + listOf(groups));
    const auto largest = std::max_element(wanted.begin(), wanted.end(), [](const auto& a, const auto& b) {
        return a.second.size() < b.second.size();
    });
    DicomStack stack;
    stack.slices = largest->second;
    groups.erase(largest->first);
    stack.left_out = listOf(groups);

    const DicomSlice& first = stack.slices.front();
    if (stack.slices.size() == 1)
        throw UserError(folder + ": a volume needs 2 or more slices; the largest series has one (" +
                        first.path.filename().string() + ")");
    const Eigen::Vector3d normal = first.normal();
    std::stable_sort(stack.slices.begin(), stack.slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
        return placeAlongNormal(a, normal) < placeAlongNormal(b, normal);
    });
    std::vector<double> places;
    for (const DicomSlice& slice : stack.slices) places.push_back(placeAlongNormal(slice, normal));
    checkDistances(stack.slices, places, folder);
    checkTilt(stack.slices, normal, folder);
    stack.slice_spacing_mm = (places.back() - places.front()) / double(places.size() - 1);
    return stack;
}

}  // namespace bonemill

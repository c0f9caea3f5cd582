#include "haptic_server/scans/dicom/dicom_gaps.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/math/pinned_math.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

constexpr double kWidestGap = 3.2;  // distances: two slices in a row may be missing
constexpr double kGap = 1.5;        // distances: one is missing
constexpr double kMaxLeaningDegrees =
    40;  // of its plane: a slice that leans further is a scout or another view
constexpr double kTurnedDegrees = 0.05;
constexpr size_t kMostNamed = 4;

double degreesBetween(const DicomSlice& a, const DicomSlice& b) {
    Eigen::Matrix3d R_WA, R_WB;
    R_WA << a.row_direction, a.column_direction, a.normal();
    R_WB << b.row_direction, b.column_direction, b.normal();
    const Eigen::Quaterniond q_AB(Eigen::Matrix3d(R_WA.transpose() * R_WB));
    return 2 * pinned::atan2(q_AB.vec().norm(), std::abs(q_AB.w())) / kDegree;
}

// Of their planes, whichever way up they are.
double leaningDegrees(const DicomSlice& a, const DicomSlice& b) {
    return pinned::atan2(a.normal().cross(b.normal()).norm(), std::abs(a.normal().dot(b.normal()))) / kDegree;
}

// Turning moves its corner, not its middle.
bool liesBetween(const DicomSlice& before, const DicomSlice& after, const DicomSlice& stranger) {
    const Eigen::Vector3d normal = before.normal();
    const double place = normal.dot(stranger.middle_mm());
    return place > normal.dot(before.middle_mm()) && place < normal.dot(after.middle_mm());
}

std::vector<DicomSlice> strangersBetween(const DicomSlice& before, const DicomSlice& after,
                                         const std::vector<DicomSlice>& strangers) {
    std::vector<DicomSlice> found;
    for (const DicomSlice& stranger : strangers)
        if (liesBetween(before, after, stranger) && leaningDegrees(before, stranger) <= kMaxLeaningDegrees)
            found.push_back(stranger);
    return found;
}

std::string differenceOf(const DicomSlice& stranger, const DicomSlice& first) {
    if (stranger.columns != first.columns || stranger.rows != first.rows)
        return printed("has %dx%d pixels, the others %dx%d", stranger.columns, stranger.rows, first.columns,
                       first.rows);
    const double turned_deg = degreesBetween(first, stranger);
    if (turned_deg > kTurnedDegrees)
        return printed("is rotated by %.3g degrees against the others", turned_deg);
    return printed("has pixels of %.4g x %.4g mm, the others %.4g x %.4g mm", stranger.pixel_spacing_mm.x(),
                   stranger.pixel_spacing_mm.y(), first.pixel_spacing_mm.x(), first.pixel_spacing_mm.y());
}

std::string differencesOf(const std::vector<DicomSlice>& strangers, const DicomSlice& first) {
    std::string text;
    for (size_t s = 0; s < std::min(strangers.size(), kMostNamed); ++s)
        text += (s > 0 ? ", " : "") + nameOfSlice(strangers[s]) + " " + differenceOf(strangers[s], first);
    if (strangers.size() > kMostNamed) text += ", and so on: " + std::to_string(strangers.size()) + " slices";
    return text;
}

}  // namespace

SliceDistances distancesOf(const std::vector<SlicePlace>& places) {
    std::vector<double> all;
    for (size_t s = 1; s < places.size(); ++s) all.push_back(places[s].along_mm - places[s - 1].along_mm);
    const auto most = std::ranges::max_element(all);
    const SliceDistances found{*std::ranges::min_element(all), 0, *most, size_t(most - all.begin())};
    std::ranges::sort(all);
    return {found.least, all[all.size() / 2], found.most, found.after_most};
}

double placeAlong(const Eigen::Vector3d& normal, const DicomSlice& slice) {
    return normal.dot(slice.position_mm);
}

std::string nameOfSlice(const DicomSlice& slice) {
    const std::string file = slice.path.filename().string();
    return slice.frame == 0 ? file : file + " frame " + std::to_string(slice.frame + 1);
}

std::string nameAndPlace(const DicomSlice& slice, const Eigen::Vector3d& normal) {
    return nameOfSlice(slice) + printed(" at %.3f mm", placeAlong(normal, slice));
}

std::string problemOfGap(const std::vector<DicomSlice>& slices, const std::vector<SlicePlace>& places,
                         const std::vector<DicomSlice>& strangers) {
    const SliceDistances distances = distancesOf(places);
    if (distances.most <= kWidestGap * distances.median) return {};
    const DicomSlice &before = slices[distances.after_most], &after = slices[distances.after_most + 1];
    const std::string ends =
        nameAndPlace(before, slices.front().normal()) + " and " +
        nameAndPlace(after, slices.front().normal()) +
        printed(" (%.4g mm apart, the others %.4g mm)", distances.most, distances.median);
    const std::vector<DicomSlice> between = strangersBetween(before, after, strangers);
    const double missing = std::round(distances.most / distances.median - 1) - double(between.size());
    const std::string missing_text = printed("%.0f slices are missing between ", missing);
    if (between.empty()) return missing_text + ends + "; complete the series";
    return "between " + ends + " " + differencesOf(between, slices.front()) +
           (missing > 0 ? printed(", and %.0f slices are missing", missing) : "") +
           "; export the series with all its slices alike";
}

std::string strangersInGaps(const std::vector<DicomSlice>& slices, const std::vector<SlicePlace>& places,
                            const std::vector<DicomSlice>& strangers) {
    const SliceDistances distances = distancesOf(places);
    std::vector<DicomSlice> found;
    for (size_t s = 1; s < slices.size(); ++s) {
        if (places[s].along_mm - places[s - 1].along_mm < kGap * distances.median) continue;
        for (const DicomSlice& stranger : strangersBetween(slices[s - 1], slices[s], strangers))
            found.push_back(stranger);
    }
    return found.empty() ? "" : "left out of the stack: " + differencesOf(found, slices.front());
}

}  // namespace bonemill

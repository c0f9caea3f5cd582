#include "haptic_server/volume/import/dicom_series.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>
#include <utility>

#include "common/math/pinned_math.h"
#include "common/units.h"
#include "common/user_error.h"

namespace bonemill {
namespace {

// Headers carry decimal text; these are coarser than its rounding and finer than any real difference.
constexpr double kSameDirection = 1e-3;
constexpr double kSamePixelSpacingMm = 1e-4;
constexpr double kSamePlaceMm = 1e-3;
constexpr double kSpacingTolerance = 0.02;  // of the median distance: nothing to speak of
constexpr double kMaxTiltDegrees = 0.1;
constexpr double kMostGantryTiltDegrees = 45;  // gantries tilt by 30 at most
constexpr double kSaidRounding = 1e-3;         // 0.06 degrees
// Scanners write positions in steps of 0.1 mm at most; so far a slice is from its place then, or this share
// of a distance.
constexpr double kRoundingMm = 0.055;
constexpr double kMostRounding = 0.2;
constexpr double kWidestGap = 3.2;  // distances: two slices in a row may be missing
constexpr double kMostFiner = 4;    // so much finer than most distances a grid may get by the least
constexpr size_t kMostScouts = 3;   // a series of so few pictures is no scan

bool belongTogether(const DicomSlice& a, const DicomSlice& b) {
    const auto isNear = [](const auto& u, const auto& v, double most) {
        return (u - v).cwiseAbs().maxCoeff() <= most;
    };
    return a.series_uid == b.series_uid && a.columns == b.columns && a.rows == b.rows &&
           isNear(a.row_direction, b.row_direction, kSameDirection) &&
           isNear(a.column_direction, b.column_direction, kSameDirection) &&
           isNear(a.pixel_spacing_mm, b.pixel_spacing_mm, kSamePixelSpacingMm);
}

using Groups = std::vector<std::vector<DicomSlice>>;

// The same groups come of the slices in any order of series.
Groups groupsOf(const std::vector<DicomSlice>& slices) {
    Groups groups;
    for (const DicomSlice& slice : slices) {
        const auto found = std::ranges::find_if(
            groups, [&](const auto& group) { return belongTogether(group.front(), slice); });
        if (found == groups.end())
            groups.push_back({slice});
        else
            found->push_back(slice);
    }
    std::ranges::stable_sort(groups, {}, [](const auto& group) { return group.front().series_uid; });
    return groups;
}

std::string describe(const std::vector<DicomSlice>& group) {
    const DicomSlice& first = group.front();
    return std::to_string(group.size()) + " slices " + std::to_string(first.columns) + "x" +
           std::to_string(first.rows) + " of " + (first.modality.empty() ? "" : first.modality + " ") +
           "series " + first.series_uid +
           (first.series_description.empty() ? "" : " (" + first.series_description + ")");
}

std::string listOf(const Groups& groups) {
    constexpr size_t kMostListed = 8;
    std::string text;
    size_t listed = 0;
    for (const auto& group : groups) {
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

// One of each place stays. Pictures that differ there are of two acquisitions.
size_t dropCopies(std::vector<DicomSlice>& slices, const Eigen::Vector3d& normal, const std::string& folder,
                  const IsSamePicture& is_same_picture) {
    std::vector<DicomSlice> kept{slices.front()};
    for (size_t s = 1; s < slices.size(); ++s) {
        const double place = placeAlongNormal(slices[s], normal);
        const double before = placeAlongNormal(kept.back(), normal);
        if (place - before >= kSamePlaceMm) {
            kept.push_back(slices[s]);
            continue;
        }
        if (!is_same_picture(kept.back(), slices[s]))
            throw UserError(folder + ": two slices lie at the same place and differ: " +
                            nameAndPlace(kept.back(), before) + " and " + nameAndPlace(slices[s], place) +
                            "; the series holds several acquisitions: keep the files of one of them");
    }
    const size_t dropped = slices.size() - kept.size();
    slices = std::move(kept);
    return dropped;
}

std::vector<SlicePlace> placesOf(const std::vector<DicomSlice>& slices) {
    std::vector<SlicePlace> places;
    for (const DicomSlice& slice : slices) {
        const DicomSlice& first = slices.front();
        const Eigen::Vector3d from_first = slice.position_mm - first.position_mm;
        places.push_back({first.normal().dot(from_first),
                          {first.row_direction.dot(from_first), first.column_direction.dot(from_first)}});
    }
    return places;
}

// A tilted gantry moves each slice aside by its share; everything else is no one stack.
void checkStraight(const std::vector<DicomSlice>& slices, const std::vector<SlicePlace>& places,
                   const std::string& folder) {
    const Eigen::Vector2d slope = places.back().aside_mm / places.back().along_mm;
    for (size_t s = 1; s < slices.size(); ++s)
        if ((places[s].aside_mm - slope * places[s].along_mm).norm() >
            std::max(0.1 * slices[0].pixel_spacing_mm.minCoeff(), kRoundingMm))
            throw UserError(
                folder + ": " + nameOf(slices[s]) +
                " is shifted sideways against the other slices; the series is not one straight stack");
}

struct Distances {
    double least, median, most;  // mm
    size_t after_most;           // the slice before the largest one
};

Distances distancesOf(const std::vector<SlicePlace>& places) {
    std::vector<double> all;
    for (size_t s = 1; s < places.size(); ++s) all.push_back(places[s].along_mm - places[s - 1].along_mm);
    const auto most = std::ranges::max_element(all);
    const Distances found{*std::ranges::min_element(all), 0, *most, size_t(most - all.begin())};
    std::ranges::sort(all);
    return {found.least, all[all.size() / 2], found.most, found.after_most};
}

// The slices' distance if it were the same everywhere, by least squares.
double evenStep(const std::vector<SlicePlace>& places) {
    const double middle = double(places.size() - 1) / 2;
    double products = 0, squares = 0;
    for (size_t s = 0; s < places.size(); ++s) {
        products += (double(s) - middle) * places[s].along_mm;
        squares += (double(s) - middle) * (double(s) - middle);
    }
    return products / squares;
}

// How far slices lie from even places, which may all be moved together.
double unevennessOf(const std::vector<SlicePlace>& places) {
    const double step = evenStep(places);
    double low = 0, high = 0;
    for (size_t s = 0; s < places.size(); ++s) {
        low = std::min(low, places[s].along_mm - step * double(s));
        high = std::max(high, places[s].along_mm - step * double(s));
    }
    return (high - low) / 2;
}

bool areEven(const std::vector<SlicePlace>& places, const Distances& distances) {
    return unevennessOf(places) <= std::min(kRoundingMm, kMostRounding * distances.median);
}

std::string textOf(const char* format, auto... numbers) {
    char text[160];
    std::snprintf(text, sizeof text, format, numbers...);
    return text;
}

// Bone of so many slices cannot be guessed.
void checkGaps(const std::vector<DicomSlice>& slices, const std::vector<SlicePlace>& places,
               const Distances& distances, const std::string& folder) {
    if (distances.most <= kWidestGap * distances.median) return;
    const size_t s = distances.after_most;
    const Eigen::Vector3d normal = slices.front().normal();
    throw UserError(folder + ": " +
                    textOf("%.0f slices are missing between ", distances.most / distances.median - 1) +
                    nameAndPlace(slices[s], placeAlongNormal(slices[s], normal)) + " and " +
                    nameAndPlace(slices[s + 1], placeAlongNormal(slices[s + 1], normal)) +
                    textOf(" (%.4g mm apart, the others %.4g mm)",
                           places[s + 1].along_mm - places[s].along_mm, distances.median) +
                    "; complete the series");
}

double tiltDegrees(const std::vector<SlicePlace>& places) {
    return pinned::atan2(places.back().aside_mm.norm(), places.back().along_mm) / kDegree;
}

void note(std::string& remark, const std::string& text) {
    remark += (remark.empty() ? "" : "; ") + text;
}

// Slices further aside were acquired in another way, and most of a slice would lie beside its neighbours.
void checkTilt(double tilt_deg, const std::string& folder) {
    if (tilt_deg > kMostGantryTiltDegrees)
        throw UserError(folder + ": " +
                        textOf("the slices are stacked %.1f degrees off their normal, more than any gantry "
                               "tilts; resample the series first",
                               tilt_deg));
}

// The places are as good as the directions that they were measured along.
void noteRounding(DicomStack& stack) {
    double rounding = 0;
    for (const DicomSlice& slice : stack.slices) rounding = std::max(rounding, slice.axes_rounding);
    if (rounding > kSaidRounding)
        note(stack.remark, textOf("the orientation is rounded in the files: it may be off by %.2g degrees",
                                  rounding / kDegree));
}

// Says why and how the slices are to be resampled.
void resample(DicomStack& stack, std::vector<SlicePlace> places, double tilt_deg,
              const Distances& distances) {
    const bool is_even = areEven(places, distances);
    std::string why;
    if (tilt_deg > kMaxTiltDegrees) note(why, textOf("gantry tilt of %.2f degrees", tilt_deg));
    if (!is_even) note(why, textOf("slices %.4g to %.4g mm apart", distances.least, distances.most));
    const double pixel_mm = stack.slices.front().pixel_spacing_mm.maxCoeff();
    note(stack.remark, "resampled to a regular grid (" + why +
                           "): between slices surfaces may be off by up to " +
                           textOf("%.2g mm", std::max(distances.most, pixel_mm) / 2));
    stack.slice_spacing_mm =
        is_even ? stack.slice_spacing_mm
                : std::min(distances.median, std::max(distances.least, distances.median / kMostFiner));
    stack.places = std::move(places);
}

// Orders the slices and finds out how they lie.
void arrange(DicomStack& stack, const std::string& folder, const IsSamePicture& is_same_picture) {
    const Eigen::Vector3d normal = stack.slices.front().normal();
    std::ranges::stable_sort(stack.slices, {},
                             [&](const DicomSlice& slice) { return placeAlongNormal(slice, normal); });
    if (const size_t copies = dropCopies(stack.slices, normal, folder, is_same_picture))
        note(stack.remark, std::to_string(copies) + " copies of slices left out");
    if (stack.slices.size() == 1)
        throw UserError(folder + ": a volume needs 2 or more slices; the largest series has one (" +
                        stack.slices.front().path.filename().string() + ")");
    std::vector<SlicePlace> places = placesOf(stack.slices);
    checkStraight(stack.slices, places, folder);
    const Distances distances = distancesOf(places);
    checkGaps(stack.slices, places, distances, folder);
    stack.slice_spacing_mm = evenStep(places);
    const double tilt_deg = tiltDegrees(places), uneven_mm = unevennessOf(places);
    checkTilt(tilt_deg, folder);
    noteRounding(stack);
    if (tilt_deg > kMaxTiltDegrees || !areEven(places, distances))
        return resample(stack, std::move(places), tilt_deg, distances);
    if (uneven_mm > kSpacingTolerance * distances.median)
        note(stack.remark,
             textOf("slices lie up to %.2g mm from where they are taken to be: rounded positions",
                    2 * uneven_mm));
}

}  // namespace

DicomStack chooseStack(const std::vector<DicomSlice>& slices, const std::string& series_uid,
                       const std::string& folder, const IsSamePicture& is_same_picture) {
    Groups groups = groupsOf(slices);
    const auto rank = [&](const std::vector<DicomSlice>& group) {
        const bool is_wanted = series_uid.empty() || group.front().series_uid == series_uid;
        return std::tuple(is_wanted, group.size() > kMostScouts && group.front().isCt(), group.size());
    };
    const auto best = std::ranges::max_element(groups, {}, rank);
    if (!std::get<0>(rank(*best)))
        throw UserError(folder + ": holds no series " + series_uid + "; it holds " + listOf(groups));
    DicomStack stack;
    stack.slices = std::move(*best);
    groups.erase(best);
    stack.left_out = listOf(groups);
    arrange(stack, folder, is_same_picture);
    return stack;
}

}  // namespace bonemill

#include "haptic_server/scans/dicom/dicom_stack.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/math/pinned_math.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

struct SliceDistances {
    double least, median, most;  // mm
    size_t after_most;           // the slice before the largest one
};

constexpr double kWidestGap = 3.2;  // distances: two slices in a row may be missing
constexpr double kGap = 1.5;        // distances: one is missing
constexpr double kMaxLeaningDegrees =
    40;  // of its plane: a slice that leans further is a scout or another view
constexpr double kTurnedDegrees = 0.05;
constexpr size_t kMostNamed = 4;

double placeAlong(const Eigen::Vector3d& normal, const DicomSlice& slice) {
    return normal.dot(slice.position_mm);
}

std::string nameAndPlace(const DicomSlice& slice, const Eigen::Vector3d& normal) {
    return nameOfSlice(slice) + printed(" at %.3f mm", placeAlong(normal, slice));
}

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

// Null: they are of one patient, place and modality.
const char* otherSourceOf(const DicomSlice& stranger, const DicomSlice& first) {
    if (stranger.patient != first.patient) return "is of another patient (Patient ID or Name)";
    if (stranger.modality != first.modality) return "is of another modality";
    if (stranger.space_uid != first.space_uid) return "has another Frame of Reference";
    return nullptr;
}

std::string differenceOf(const DicomSlice& stranger, const DicomSlice& first) {
    if (const char* const source = otherSourceOf(stranger, first)) return source;
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

// Why a slice is alone that could lie among others of its series; empty: there are none.
std::string othersOf(const DicomSlice& slice, const std::vector<DicomSlice>& strangers) {
    std::vector<DicomSlice> others;
    for (const DicomSlice& stranger : strangers)
        if (otherSourceOf(stranger, slice)) others.push_back(stranger);
    return others.empty() ? "" : "; of its series " + differencesOf(others, slice);
}

// There are two places at least, ascending.
SliceDistances distancesOf(const std::vector<SlicePlace>& places) {
    std::vector<double> all;
    for (size_t s = 1; s < places.size(); ++s) all.push_back(places[s].along_mm - places[s - 1].along_mm);
    const auto most = std::ranges::max_element(all);
    const SliceDistances found{*std::ranges::min_element(all), 0, *most, size_t(most - all.begin())};
    std::ranges::sort(all);
    return {found.least, all[all.size() / 2], found.most, found.after_most};
}

// Empty, or that N slices are missing that bone cannot be guessed there, and where.
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

// Which of the strangers lie where a slice of the stack should, and why they are none; empty: none does.
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

// Headers carry decimal text; these are coarser than its rounding and finer than any real difference.
constexpr double kSamePlaceMm = 1e-3;
constexpr double kSpacingTolerance = 0.02;  // of the median distance: nothing to speak of
constexpr double kMaxTiltDegrees = 0.1;
constexpr double kMaxGantryTiltDegrees = 45;  // gantries tilt by 30 at most
constexpr double kSaidRounding = 1e-3;        // 0.06 degrees
// Scanners write positions in steps of 0.1 mm at most; so far a slice is from its place then, or this share
// of a distance.
constexpr double kRoundingMm = 0.055;
constexpr double kMaxRounding = 0.2;
constexpr double kMaxFiner = 4;  // so much finer than most distances a grid may get by the least

void note(std::string& remark, const std::string& text) {
    remark += (remark.empty() || text.empty() ? "" : "; ") + text;
}

// How many slices lie at each place, ascending.
std::vector<size_t> slicesAtPlaces(const std::vector<DicomSlice>& slices, const Eigen::Vector3d& normal) {
    std::vector<size_t> counts;
    double place = 0;
    for (const DicomSlice& slice : slices) {
        if (counts.empty() || placeAlong(normal, slice) - place >= kSamePlaceMm) {
            place = placeAlong(normal, slice);
            counts.push_back(0);
        }
        ++counts.back();
    }
    return counts;
}

// What to do depends on how many there are, and of how many places.
std::string problemOfSamePlace(const std::vector<DicomSlice>& slices, const DicomSlice& a,
                               const DicomSlice& b) {
    const Eigen::Vector3d normal = slices.front().normal();
    const std::vector<size_t> counts = slicesAtPlaces(slices, normal);
    const std::string both = nameAndPlace(a, normal) + " and " + nameAndPlace(b, normal);
    if (counts.size() == 1)
        return "all its " + std::to_string(slices.size()) +
               " slices lie at the same place and differ, such as " + both +
               ": they show one place at several times, or their export has lost where each of them lies, "
               "and "
               "are no volume; take another series, or export this one anew with the Image Position of each "
               "slice";
    const std::string two = "two slices lie at the same place and differ: " + both;
    if (std::ranges::all_of(counts, [&](size_t count) { return count == counts.front(); }))
        return two + ", and so at each of " + std::to_string(counts.size()) + " places: the series holds " +
               std::to_string(counts.front()) +
               " acquisitions that nothing in the headers tells apart: keep the files of one of them";
    const auto more = std::ranges::count_if(counts, [](size_t count) { return count > 1; });
    return two + ", and so at " + std::to_string(more) + " of " + std::to_string(counts.size()) +
           " places: parts of other acquisitions that nothing in the headers tells apart, or a wrong Image "
           "Position: move the files that do not belong to the stack elsewhere, or export the series anew";
}

// One of each place stays. Pictures that differ there are of two acquisitions: the stack's problem.
void dropCopies(DicomStack& stack, const Eigen::Vector3d& normal, const IsSamePicture& is_same_picture) {
    std::vector<DicomSlice> kept{stack.slices.front()};
    for (size_t s = 1; s < stack.slices.size(); ++s) {
        const DicomSlice& slice = stack.slices[s];
        if (placeAlong(normal, slice) - placeAlong(normal, kept.back()) >= kSamePlaceMm) {
            kept.push_back(slice);
            continue;
        }
        stack.has_several = !is_same_picture(kept.back(), slice);
        if (!stack.has_several) continue;
        stack.problem = problemOfSamePlace(stack.slices, kept.back(), slice);
        return;
    }
    if (const size_t copies = stack.slices.size() - kept.size())
        note(stack.remark, std::to_string(copies) + " copies of slices left out");
    stack.slices = std::move(kept);
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

double medianOf(std::vector<double> numbers) {
    std::ranges::sort(numbers);
    return numbers[numbers.size() / 2];
}

// The medians do not see the few slices that are not where the others are.
size_t farthestAside(const std::vector<SlicePlace>& places) {
    std::vector<double> distances(places.size(), 0);
    for (const int axis : {0, 1}) {
        std::vector<double> slopes, starts;
        const size_t half = places.size() / 2;
        for (size_t s = 0; s + half < places.size(); ++s)
            slopes.push_back((places[s + half].aside_mm[axis] - places[s].aside_mm[axis]) /
                             (places[s + half].along_mm - places[s].along_mm));
        const double slope = medianOf(slopes);
        for (const SlicePlace& place : places)
            starts.push_back(place.aside_mm[axis] - slope * place.along_mm);
        const double start = medianOf(starts);
        for (size_t s = 0; s < places.size(); ++s) distances[s] += std::abs(starts[s] - start);
    }
    return size_t(std::ranges::max_element(distances) - distances.begin());
}

// A tilted gantry moves each slice aside by its share; everything else is no one stack.
std::string problemOfShifts(const std::vector<DicomSlice>& slices, const std::vector<SlicePlace>& places) {
    const Eigen::Vector2d slope = places.back().aside_mm / places.back().along_mm;
    const double most = std::max(0.1 * slices[0].pixel_spacing_mm.minCoeff(), kRoundingMm);
    const auto is_straight = [&](const SlicePlace& place) {
        return (place.aside_mm - slope * place.along_mm).norm() <= most;
    };
    if (std::ranges::all_of(places, is_straight)) return {};
    return nameOfSlice(slices[farthestAside(places)]) +
           " is shifted sideways against the other slices; the series is not one straight stack";
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

bool areEven(const std::vector<SlicePlace>& places, const SliceDistances& distances) {
    return unevennessOf(places) <= std::min(kRoundingMm, kMaxRounding * distances.median);
}

double tiltDegrees(const std::vector<SlicePlace>& places) {
    return pinned::atan2(places.back().aside_mm.norm(), places.back().along_mm) / kDegree;
}

// Slices further aside were acquired in another way, and most of a slice would lie beside its neighbours.
std::string problemOfTilt(double tilt_deg) {
    if (tilt_deg <= kMaxGantryTiltDegrees) return {};
    return printed(
        "the slices are stacked %.1f degrees off their normal, more than any gantry tilts; resample the "
        "series first",
        tilt_deg);
}

// All that is wrong is said at once, and of a tilt that alone would be mended where something else is wrong.
std::string problemsOf(const DicomStack& stack, const std::vector<SlicePlace>& places, double tilt_deg,
                       const std::vector<DicomSlice>& strangers) {
    std::string problems;
    const std::string shifts = problemOfShifts(stack.slices, places);
    note(problems, shifts);
    note(problems, problemOfGap(stack.slices, places, strangers));
    note(problems, problemOfTilt(tilt_deg));
    const bool is_mere_tilt = tilt_deg > kMaxTiltDegrees && tilt_deg <= kMaxGantryTiltDegrees;
    if (!problems.empty() && shifts.empty() && is_mere_tilt)
        note(problems, printed("beside that, the gantry is tilted by %.2f degrees", tilt_deg));
    return problems;
}

// The places are as good as the directions that they were measured along.
void noteRounding(DicomStack& stack) {
    double rounding = 0;
    for (const DicomSlice& slice : stack.slices) rounding = std::max(rounding, slice.rounding);
    if (rounding > kSaidRounding)
        note(stack.remark, printed("the orientation is rounded in the files: it may be off by %.2g degrees",
                                   rounding / kDegree));
}

// Says why and how the slices are to be resampled.
void resample(DicomStack& stack, std::vector<SlicePlace> places, double tilt_deg,
              const std::vector<DicomSlice>& strangers) {
    const SliceDistances distances = distancesOf(places);
    std::string why;
    if (tilt_deg > kMaxTiltDegrees) note(why, printed("gantry tilt of %.2f degrees", tilt_deg));
    if (stack.is_uneven) note(why, printed("slices %.4g to %.4g mm apart", distances.least, distances.most));
    const double pixel_mm = stack.slices.front().pixel_spacing_mm.maxCoeff();
    note(stack.remark, "resampled to a regular grid (" + why +
                           "): between slices surfaces may be off by up to " +
                           printed("%.2g mm", std::max(distances.most, pixel_mm) / 2));
    note(stack.remark, strangersInGaps(stack.slices, places, strangers));
    if (stack.is_uneven)
        stack.slice_spacing_mm =
            std::min(distances.median, std::max(distances.least, distances.median / kMaxFiner));
    stack.places = std::move(places);
}

void findPlaces(DicomStack& stack, const std::vector<DicomSlice>& strangers) {
    std::vector<SlicePlace> places = placesOf(stack.slices);
    const double tilt_deg = tiltDegrees(places), uneven_mm = unevennessOf(places);
    const SliceDistances distances = distancesOf(places);
    stack.slice_spacing_mm = evenStep(places);
    stack.problem = problemsOf(stack, places, tilt_deg, strangers);
    stack.is_uneven = !areEven(places, distances);
    if (!stack.problem.empty()) return;
    noteRounding(stack);
    if (tilt_deg > kMaxTiltDegrees || stack.is_uneven)
        return resample(stack, std::move(places), tilt_deg, strangers);
    if (uneven_mm > kSpacingTolerance * distances.median)
        note(stack.remark,
             printed("slices lie up to %.2g mm from where they are taken to be: rounded positions",
                     2 * uneven_mm));
}

}  // namespace

std::string nameOfSlice(const DicomSlice& slice) {
    const std::string file = slice.path.filename().string();
    return slice.frame == 0 ? file : file + " frame " + std::to_string(slice.frame + 1);
}

DicomStack arrangedStack(std::vector<DicomSlice> slices, const std::vector<DicomSlice>& strangers,
                         const IsSamePicture& is_same_picture) {
    DicomStack stack;
    stack.slices = std::move(slices);
    const Eigen::Vector3d normal = stack.slices.front().normal();
    std::ranges::stable_sort(stack.slices, {},
                             [&](const DicomSlice& slice) { return placeAlong(normal, slice); });
    try {
        dropCopies(stack, normal, is_same_picture);
    } catch (const UserError& error) {  // one of the pictures cannot be read
        stack.problem = error.what();
    }
    if (!stack.problem.empty()) return stack;
    if (stack.slices.size() == 1)
        stack.problem = "a volume needs 2 or more slices; there is one (" +
                        nameOfSlice(stack.slices.front()) + ")" + othersOf(stack.slices.front(), strangers) +
                        (stack.remark.empty() ? "" : "; " + stack.remark);
    else
        findPlaces(stack, strangers);
    return stack;
}

}  // namespace bonemill

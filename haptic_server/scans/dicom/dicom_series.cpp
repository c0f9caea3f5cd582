#include "haptic_server/scans/dicom/dicom_series.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/dicom/dicom_parts.h"

namespace bonemill {
namespace {

// A kernel is one of bone where it holds this word, ...
constexpr const char* kBoneWords[] = {
    "BONE",   // GE: BONE, BONEPLUS, HD BONE; cone beams
    "EDGE",   // GE
    "SHARP",  // cone beams
    "OSTEO",  // Siemens protocols
};

// ... begins with these letters, ...
constexpr const char* kBoneLetters[] = {"YA", "YB", "YC", "YD"};  // Philips

// ... or with these letters and a number within this range: the higher, the sharper.
constexpr struct {
    const char* letters;
    int low, high;
} kBoneNumbers[] = {
    {"B", 60, 80},  {"H", 60, 80},                                   // Siemens: body, head (B70f, H60s)
    {"BR", 60, 89}, {"HR", 60, 89},                                  // its newer ones (Br64d, Hr68)
    {"U", 70, 90},  {"UR", 70, 90}, {"UB", 70, 90}, {"UH", 70, 90},  // ultra-sharp (U90u, Ur77)
    {"S", 80, 90},                                                   // special (S80s)
    {"FC", 30, 35}, {"FC", 80, 85},                                  // Canon, Toshiba: bone, inner ear
};

constexpr double kMaxThicker = 2;

bool hasNumberWithin(const std::string& digits, int low, int high) {
    if (digits.size() < 2 || !std::isdigit(static_cast<unsigned char>(digits[0])) ||
        !std::isdigit(static_cast<unsigned char>(digits[1])))
        return false;
    const int number = 10 * (digits[0] - '0') + (digits[1] - '0');
    return number >= low && number <= high;
}

bool isOfSameSeries(const DicomStack& a, const DicomStack& b) {
    return a.slices.front().series_uid == b.slices.front().series_uid;
}

// What lies beside the main stack of a series, such as the slices in its gap that are turned, is no scan.
bool isFragment(const DicomStack& stack, const std::vector<DicomStack>& stacks) {
    return std::ranges::any_of(stacks, [&](const DicomStack& other) {
        return isOfSameSeries(stack, other) && other.told_by.empty() && !other.problem.empty() &&
               other.slices.size() > stack.slices.size();
    });
}

bool canBeUsed(const DicomStack& stack, const std::vector<DicomStack>& stacks) {
    return stack.problem.empty() && !isScout(stack) && !isFragment(stack, stacks);
}

bool isCt(const DicomStack& stack) {
    return stack.slices.front().isCt();
}

double thinnestOf(const std::vector<DicomStack>& stacks) {
    double thinnest = std::numeric_limits<double>::max();
    const auto counts = [&](const DicomStack& stack, bool is_ct) {
        return canBeUsed(stack, stacks) && isCt(stack) == is_ct;
    };
    const bool any_ct =
        std::ranges::any_of(stacks, [&](const DicomStack& stack) { return counts(stack, true); });
    for (const DicomStack& stack : stacks)
        if (counts(stack, any_ct)) thinnest = std::min(thinnest, stack.slice_spacing_mm);
    return thinnest;
}

bool hasBoneKernel(const DicomStack& stack) {
    return isBoneKernel(stack.slices.front().traits.kernel);
}

std::string whyOf(const DicomStack& stack) {
    const DicomSlice& first = stack.slices.front();
    std::string why = first.modality.empty() ? "" : first.modality + ", ";
    if (hasBoneKernel(stack)) why += "bone kernel " + first.traits.kernel + ", ";
    why += printed("slices %.4g mm apart, ", stack.slice_spacing_mm) + std::to_string(stack.slices.size()) +
           " slices";
    if (!isCt(stack)) why += "; it is no CT, so that bone may not be its brightest";
    if (!stack.remark.empty()) why += "; " + stack.remark;
    return why;
}

// Headers carry decimal text; these are coarser than its rounding and finer than any real difference.
constexpr double kSameDirection = 1e-3;
constexpr double kSamePixelSpacingMm = 1e-4;
constexpr size_t kMaxScouts = 3;  // a series of so few pictures is no scan

bool belongTogether(const DicomSlice& a, const DicomSlice& b) {
    const auto isNear = [](const auto& u, const auto& v, double most) {
        return (u - v).cwiseAbs().maxCoeff() <= most;
    };
    return a.series_uid == b.series_uid && a.patient == b.patient && a.space_uid == b.space_uid &&
           a.modality == b.modality && a.columns == b.columns && a.rows == b.rows &&
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

std::vector<DicomSlice> strangersOf(const std::vector<DicomSlice>& group, const Groups& groups) {
    std::vector<DicomSlice> strangers;
    for (const auto& other : groups)
        if (&other != &group && other.front().series_uid == group.front().series_uid)
            strangers.insert(strangers.end(), other.begin(), other.end());
    return strangers;
}

using SeriesAndName = std::pair<std::string, std::string>;

SeriesAndName seriesAndName(const DicomStack& stack) {
    return {stack.slices.front().series_uid, stack.name};
}

void countSharedNames(std::vector<DicomStack>& stacks) {
    std::map<SeriesAndName, int> all, counted;
    for (const DicomStack& stack : stacks) ++all[seriesAndName(stack)];
    for (DicomStack& stack : stacks) {
        const SeriesAndName shared = seriesAndName(stack);
        if (all[shared] > 1) stack.name += "/" + std::to_string(++counted[shared]);
    }
}

std::string sizeAndTitle(const DicomStack& stack) {
    const DicomSlice& first = stack.slices.front();
    return std::to_string(stack.slices.size()) + " slices " + std::to_string(first.columns) + "x" +
           std::to_string(first.rows) + " of " + (first.modality.empty() ? "" : first.modality + " ") +
           titleOf(stack) + (first.series_description.empty() ? "" : " (" + first.series_description + ")");
}

std::string listOf(const std::vector<const DicomStack*>& stacks, std::string (*say)(const DicomStack&)) {
    constexpr size_t kMaxListed = 8;
    std::string text;
    for (size_t s = 0; s < stacks.size(); ++s) {
        if (s == kMaxListed) return text + "; ...";
        text += (text.empty() ? "" : "; ") + say(*stacks[s]);
    }
    return text;
}

std::string nameAndSize(const DicomStack& stack) {
    return stack.name + " (" + std::to_string(stack.slices.size()) + " slices)";
}

bool areParts(const DicomStack& a, const DicomStack& b) {
    return !a.told_by.empty() && belongTogether(a.slices.front(), b.slices.front());
}

// What people type has no control characters, and need not repeat what was counted.
bool isNamed(const DicomStack& stack, const std::string& wanted) {
    return stack.name == wanted || stack.name.substr(0, stack.name.rfind('/')) == wanted;
}

bool isWanted(const DicomStack& stack, const DicomWish& wish) {
    return (wish.series_uid.empty() || stack.slices.front().series_uid == wish.series_uid) &&
           (wish.acquisition.empty() || isNamed(stack, wish.acquisition));
}

bool holds(const DicomStack& stack, const std::filesystem::path& file) {
    return std::ranges::any_of(stack.slices, [&](const DicomSlice& slice) { return slice.path == file; });
}

// How well the stacks show bone. Of those that cannot be used the largest scan comes first.
class BoneRank {
  public:
    // The stacks must outlive it.
    explicit BoneRank(const std::vector<DicomStack>& stacks)
        // Distances differ in their last digits by the rounding of the positions.
        : stacks_(stacks), most_mm_(kMaxThicker * thinnestOf(stacks) * 1.001) {}

    // The better, the greater.
    auto operator()(const DicomStack& stack) const {
        const bool can_be_used = canBeUsed(stack, stacks_), is_scan = !isScout(stack);
        const bool is_sharp = can_be_used && hasBoneKernel(stack) && stack.slice_spacing_mm <= most_mm_;
        return std::tuple(can_be_used, is_scan, is_scan && isCt(stack), is_sharp,
                          can_be_used ? -std::lround(100 * stack.slice_spacing_mm) : 0, stack.slices.size(),
                          -acquisitionOf(stack).value_or(std::numeric_limits<double>::max()),
                          stack.slices.front().traits.image_type.starts_with("ORIGINAL"));
    }

  private:
    const std::vector<DicomStack>& stacks_;
    double most_mm_;
};

std::string nameOfWish(const DicomWish& wish) {
    std::string text = wish.series_uid.empty() ? "" : "series " + wish.series_uid;
    if (!wish.acquisition.empty()) text += (text.empty() ? "" : ", ") + ("acquisition " + wish.acquisition);
    return text;
}

std::vector<const DicomStack*> pointersTo(const std::vector<DicomStack>& stacks) {
    std::vector<const DicomStack*> pointers;
    for (const DicomStack& stack : stacks) pointers.push_back(&stack);
    return pointers;
}

std::string sizeTitleAndProblem(const DicomStack& stack) {
    return sizeAndTitle(stack) + (stack.problem.empty() ? "" : ", which cannot be used: " + stack.problem);
}

// Of other series than the chosen one.
std::string damagedElsewhere(const std::vector<DamagedFile>& damaged) {
    constexpr size_t kMaxListed = 4;
    std::string text;
    for (size_t n = 0; n < std::min(damaged.size(), kMaxListed); ++n)
        text += (n > 0 ? ", " : "") + damaged[n].problem;
    return damaged.size() > kMaxListed ? text + ", and so on: " + std::to_string(damaged.size()) + " files"
                                       : text;
}

// Says of stacks that may miss pictures which file is at fault.
void noteDamage(std::vector<DicomStack>& stacks, const std::vector<DamagedFile>& damaged) {
    for (DicomStack& stack : stacks) {
        const std::string& uid = stack.slices.front().series_uid;
        const auto concerns = [&](const DamagedFile& file) {
            return file.series_uid.empty() || file.series_uid == uid;
        };
        const auto file = std::ranges::find_if(damaged, concerns);
        if (file == damaged.end()) continue;
        const char* const which =
            file->series_uid.empty() ? "a file that may be of this series" : "a file of this series";
        stack.problem += (stack.problem.empty() ? "" : "; ") + std::string(which) +
                         " cannot be read: " + file->problem +
                         "; copy it anew, or move it elsewhere to do without it";
    }
}

// Slices of which only some say their scale would not be alike.
void noteScales(DicomStack& stack) {
    const auto says = [](const DicomSlice& slice) { return slice.rescale.has_value(); };
    const auto silent = std::ranges::find_if_not(stack.slices, says);
    if (silent == stack.slices.end() || std::ranges::none_of(stack.slices, says)) return;
    const auto count = std::ranges::count_if(stack.slices, [&](const auto& slice) { return !says(slice); });
    stack.problem += (stack.problem.empty() ? "" : "; ") + nameOfSlice(*silent) +
                     " does not state its Rescale Slope and Intercept (" + std::to_string(count) + " of " +
                     std::to_string(stack.slices.size()) + " slices do not); export the series anew";
}

// The parts of its series are named, other stacks listed.
DicomChoice choiceOf(const std::vector<DicomStack>& stacks, const DicomStack& best) {
    DicomChoice choice;
    std::vector<const DicomStack*> parts, others;
    for (const DicomStack& stack : stacks) {
        if (areParts(best, stack))
            parts.push_back(&stack);
        else if (&stack != &best)
            others.push_back(&stack);
    }
    choice.left_out = listOf(others, sizeTitleAndProblem);
    if (!parts.empty())
        choice.how_chosen = "the series holds " + std::to_string(parts.size()) +
                            " stacks that overlap, told apart by " + best.told_by + ": " +
                            listOf(parts, nameAndSize) + "; taken: " + best.name +
                            "; volume.acquisition (make-case: --acquisition) takes another";
    choice.stack = best;
    return choice;
}

}  // namespace

bool isBoneKernel(const std::string& kernel) {
    std::string name = kernel;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    for (const char* word : kBoneWords)
        if (name.find(word) != std::string::npos) return true;
    for (const char* letters : kBoneLetters)
        if (name.starts_with(letters)) return true;
    return std::ranges::any_of(kBoneNumbers, [&](const auto& range) {
        const std::string letters = range.letters;
        return name.starts_with(letters) &&
               hasNumberWithin(name.substr(letters.size()), range.low, range.high);
    });
}

BoneRecommendation recommendForBone(const std::vector<DicomStack>& stacks) {
    const auto best = std::ranges::max_element(stacks, {}, BoneRank(stacks));
    if (best == stacks.end() || !canBeUsed(*best, stacks)) return {};
    return {&*best, whyOf(*best)};
}

std::vector<DicomStack> stacksOf(const std::vector<DicomSlice>& slices, const IsSamePicture& is_same_picture,
                                 const std::vector<DamagedFile>& damaged) {
    const Groups groups = groupsOf(slices);
    std::vector<DicomStack> stacks;
    for (const auto& group : groups)
        for (DicomStack& part : partsOf(group, strangersOf(group, groups), is_same_picture))
            stacks.push_back(std::move(part));
    countSharedNames(stacks);
    for (DicomStack& stack : stacks) noteScales(stack);
    noteDamage(stacks, damaged);
    return stacks;
}

std::string titleOf(const DicomStack& stack) {
    return "series " + stack.slices.front().series_uid +
           (stack.name.empty() ? "" : ", acquisition " + stack.name);
}

bool isScout(const DicomStack& stack) {
    return stack.slices.size() <= kMaxScouts ||
           stack.slices.front().traits.image_type.find("LOCALIZER") != std::string::npos;
}

DicomChoice chooseStack(const std::vector<DicomSlice>& slices, const DicomWish& wish,
                        const std::string& folder, const IsSamePicture& is_same_picture,
                        const std::vector<DamagedFile>& damaged) {
    // No picture of a series is read that is not wanted.
    const auto is_same = [&](const DicomSlice& a, const DicomSlice& b) {
        return (!wish.series_uid.empty() && a.series_uid != wish.series_uid) || is_same_picture(a, b);
    };
    const std::vector<DicomStack> stacks = stacksOf(slices, is_same, damaged);
    const BoneRank for_bone(stacks);
    const auto rank = [&](const DicomStack& stack) {
        const bool is_named = !wish.file.empty() && !isScout(stack) && holds(stack, wish.file);
        return std::tuple(isWanted(stack, wish), is_named, for_bone(stack));
    };
    const auto best = std::ranges::max_element(stacks, {}, rank);
    if (!isWanted(*best, wish))
        throw UserError(folder + ": holds no " + nameOfWish(wish) + "; it holds " +
                        listOf(pointersTo(stacks), sizeAndTitle));
    if (!best->problem.empty()) throw UserError(folder + ": " + best->problem);
    DicomChoice choice = choiceOf(stacks, *best);
    choice.damaged = damagedElsewhere(damaged);
    return choice;
}

}  // namespace bonemill

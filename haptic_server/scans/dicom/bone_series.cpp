#include "haptic_server/scans/dicom/bone_series.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <tuple>

#include "common/text/printed_text.h"
#include "haptic_server/scans/dicom/dicom_series.h"

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

std::string upperCase(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    return text;
}

bool canBeUsed(const DicomStack& stack) {
    return stack.problem.empty() && !isScout(stack);
}

bool isCt(const DicomStack& stack) {
    return stack.slices.front().isCt();
}

double thinnestOf(const std::vector<DicomStack>& stacks) {
    double thinnest = std::numeric_limits<double>::max();
    const bool any_ct =
        std::ranges::any_of(stacks, [](const DicomStack& stack) { return canBeUsed(stack) && isCt(stack); });
    for (const DicomStack& stack : stacks)
        if (canBeUsed(stack) && isCt(stack) == any_ct) thinnest = std::min(thinnest, stack.slice_spacing_mm);
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

}  // namespace

bool isBoneKernel(const std::string& kernel) {
    const std::string name = upperCase(kernel);
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
    // Distances differ in their last digits by the rounding of the positions.
    const double limit = kMaxThicker * thinnestOf(stacks) * 1.001;
    const auto rank = [&](const DicomStack& stack) {
        return std::tuple(canBeUsed(stack), isCt(stack),
                          hasBoneKernel(stack) && stack.slice_spacing_mm <= limit,
                          -std::lround(100 * stack.slice_spacing_mm), stack.slices.size(),
                          stack.slices.front().traits.image_type.starts_with("ORIGINAL"));
    };
    const auto best = std::ranges::max_element(stacks, {}, rank);
    if (best == stacks.end() || !canBeUsed(*best)) return {};
    return {&*best, whyOf(*best)};
}

}  // namespace bonemill

#include "haptic_server/scans/dicom/dicom_parts.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "common/text/printed_text.h"
#include "haptic_server/scans/pixels/dicom_rescale.h"

namespace bonemill {
namespace {

struct Trait {
    const char* said;    // of what tells parts apart
    const char* prefix;  // of a part's name, before the value
    std::string DicomTraits::*value;
    bool is_mixed;  // may pictures of one volume differ by it, one beside the other?
    bool is_time = false;
};

// The times come last: where each slice has its own they tell nothing.
constexpr Trait kTraits[] = {
    {"acquisition number", "", &DicomTraits::acquisition_number, true},
    {"temporal position", "phase ", &DicomTraits::temporal_position, false},
    {"b-value", "b ", &DicomTraits::b_value, false},
    {"kernel", "kernel ", &DicomTraits::kernel, false},
    {"image type", "type ", &DicomTraits::image_type, true},
    {"acquisition time", "time ", &DicomTraits::acquisition_time, true, true},
    {"content time", "content time ", &DicomTraits::content_time, true, true},
};

using Split = std::vector<const Trait*>;

// Numbers go before other texts, and by their size.
using Rank = std::tuple<bool, double, std::string>;

Rank rankOf(const std::string& value) {
    const auto numbers = decimalNumbers(value);
    if (!numbers || numbers->size() != 1) return {true, 0, value};
    return {false, numbers->front(), value};
}

std::vector<Split> splits() {
    std::vector<Split> all;
    for (const Trait& trait : kTraits) all.push_back({&trait});
    for (const Trait& first : kTraits)
        for (const Trait* second = &first + 1; second != std::end(kTraits); ++second)
            all.push_back({&first, second});
    return all;
}

std::string partName(const Split& split, const DicomTraits& traits) {
    std::string name;
    for (const Trait* trait : split) {
        std::string value = traits.*trait->value;
        std::ranges::replace(value, '\\', '/');
        name += (name.empty() ? "" : ", ") + std::string(trait->prefix) + (value.empty() ? "none" : value);
    }
    return printable(name);
}

std::string wordsOf(const Split& split) {
    std::string words;
    for (const Trait* trait : split) words += (words.empty() ? "" : " and ") + std::string(trait->said);
    return words;
}

// Along the normal, mm.
std::pair<double, double> extentOf(const DicomStack& stack) {
    const Eigen::Vector3d normal = stack.slices.front().normal();
    return {normal.dot(stack.slices.front().position_mm), normal.dot(stack.slices.back().position_mm)};
}

// Ranges that only touch make one volume together.
bool allOverlap(const std::vector<DicomStack>& stacks) {
    constexpr double kShare = 0.5;  // of the shorter
    const std::pair<double, double> first = extentOf(stacks.front());
    return std::ranges::all_of(stacks, [&first](const DicomStack& stack) {
        const auto [low, high] = first;
        const auto [from, to] = extentOf(stack);
        return std::min(high, to) - std::max(low, from) > kShare * std::min(high - low, to - from);
    });
}

// None where the traits of all slices are alike, where a part is none yet, and where times only part a volume
// into the ranges that were scanned one after the other.
std::vector<DicomStack> splitBy(const Split& split, const std::vector<DicomSlice>& slices,
                                const std::vector<DicomSlice>& strangers,
                                const IsSamePicture& is_same_picture) {
    std::map<std::vector<Rank>, std::vector<DicomSlice>> parts;
    for (const DicomSlice& slice : slices) {
        std::vector<Rank> rank;
        for (const Trait* trait : split) rank.push_back(rankOf(slice.traits.*trait->value));
        parts[rank].push_back(slice);
    }
    std::vector<DicomStack> stacks;
    if (parts.size() < 2) return stacks;
    for (auto& [rank, part] : parts) {
        const std::string name = partName(split, part.front().traits);
        stacks.push_back(arrangedStack(std::move(part), strangers, is_same_picture));
        if (stacks.back().has_several) return {};
        stacks.back().name = name;
        stacks.back().told_by = wordsOf(split);
    }
    if (std::ranges::any_of(split, &Trait::is_time) && !allOverlap(stacks)) return {};
    return stacks;
}

size_t properSlices(const std::vector<DicomStack>& stacks) {
    size_t count = 0;
    for (const DicomStack& stack : stacks) count += stack.problem.empty() ? stack.slices.size() : 0;
    return count;
}

bool areProper(const std::vector<DicomStack>& stacks) {
    return !stacks.empty() &&
           std::ranges::all_of(stacks, [](const DicomStack& stack) { return stack.problem.empty(); });
}

std::string commonNumber(const std::vector<DicomSlice>& slices) {
    const std::string& number = slices.front().traits.acquisition_number;
    const auto has_it = [&](const DicomSlice& slice) { return slice.traits.acquisition_number == number; };
    return std::ranges::all_of(slices, has_it) ? number : "";
}

// Stacks of which each lies between the slices of the other.
bool areInterleaved(const Trait& trait, const DicomStack& whole, const std::vector<DicomStack>& stacks) {
    const auto is_even = [](const DicomStack& stack) { return !stack.is_uneven; };
    return areProper(stacks) && allOverlap(stacks) &&
           (!trait.is_mixed || !whole.problem.empty() ||
            (whole.is_uneven && std::ranges::all_of(stacks, is_even)));
}

// A stack of one slice tells nothing of what is wrong with it.
bool haveSlices(const std::vector<DicomStack>& stacks) {
    return !stacks.empty() &&
           std::ranges::all_of(stacks, [](const DicomStack& stack) { return stack.slices.size() > 1; });
}

// How good a split is: stacks that overlap are acquisitions and phases, others may be ranges that were
// scanned one after the other and belong together. Where none leaves a proper stack, the problems of each one
// are worth more than that they overlap.
std::tuple<bool, bool, size_t, bool> worthOf(const std::vector<DicomStack>& stacks) {
    return {areProper(stacks) && allOverlap(stacks), areProper(stacks), properSlices(stacks),
            haveSlices(stacks)};
}

// Of stacks at the same places.
std::vector<DicomStack> bestSplit(const std::vector<DicomSlice>& slices,
                                  const std::vector<DicomSlice>& strangers,
                                  const IsSamePicture& is_same_picture) {
    std::vector<DicomStack> best;
    for (const Split& split : splits()) {
        std::vector<DicomStack> stacks = splitBy(split, slices, strangers, is_same_picture);
        if (worthOf(stacks) > worthOf(best)) best = std::move(stacks);
        if (std::get<0>(worthOf(best))) break;
    }
    return best;
}

}  // namespace

std::vector<DicomStack> partsOf(const std::vector<DicomSlice>& slices,
                                const std::vector<DicomSlice>& strangers,
                                const IsSamePicture& is_same_picture) {
    DicomStack whole = arrangedStack(slices, strangers, is_same_picture);
    whole.name = printable(commonNumber(slices));
    if (whole.has_several) {
        std::vector<DicomStack> best = bestSplit(slices, strangers, is_same_picture);
        if (!best.empty()) return best;
        return {std::move(whole)};
    }
    for (const Trait& trait : kTraits) {
        std::vector<DicomStack> stacks = splitBy({&trait}, whole.slices, strangers, is_same_picture);
        if (areInterleaved(trait, whole, stacks)) return stacks;
    }
    return {std::move(whole)};
}

std::optional<double> acquisitionOf(const DicomStack& stack) {
    const auto numbers = decimalNumbers(commonNumber(stack.slices));
    if (!numbers || numbers->size() != 1) return std::nullopt;
    return numbers->front();
}

}  // namespace bonemill

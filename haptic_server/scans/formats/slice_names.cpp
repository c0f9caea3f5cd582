#include "haptic_server/scans/formats/slice_names.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <string_view>

namespace bonemill {
namespace {

constexpr size_t kMostListed = 4;

size_t endOfDigits(const std::string& text, size_t from) {
    while (from < text.size() && std::isdigit(static_cast<unsigned char>(text[from]))) ++from;
    return from;
}

// The digits of the number that begins there, without leading zeros.
std::string_view numberAt(const std::string& text, size_t begin, size_t end) {
    while (begin + 1 < end && text[begin] == '0') ++begin;
    return std::string_view(text).substr(begin, end - begin);
}

struct NameParts {
    std::string pattern;  // with "#" for each number
    std::vector<int64_t> numbers;
};

// Longer ones, such as parts of UIDs, count nothing.
constexpr size_t kMostDigits = 15;

NameParts partsOfName(const std::string& name) {
    NameParts parts;
    for (size_t at = 0; at < name.size();) {
        const size_t end = endOfDigits(name, at);
        if (end == at) {
            parts.pattern += name[at++];
            continue;
        }
        const std::string_view digits = numberAt(name, at, end);
        parts.pattern += '#';
        parts.numbers.push_back(digits.size() > kMostDigits ? 0 : std::atoll(std::string(digits).c_str()));
        at = end;
    }
    return parts;
}

using Numbers = std::vector<int64_t>;

// The number that stands at this place in each name.
Numbers column(const std::vector<NameParts>& names, size_t place) {
    Numbers numbers;
    for (const NameParts& name : names) numbers.push_back(name.numbers[place]);
    return numbers;
}

// From each number to the next; there are two at least.
Numbers stepsOf(const Numbers& numbers) {
    Numbers steps;
    for (size_t n = 1; n < numbers.size(); ++n) steps.push_back(numbers[n] - numbers[n - 1]);
    return steps;
}

// The most frequent, of several the smallest.
int64_t usualStep(const Numbers& steps) {
    std::map<int64_t, size_t> counts;
    for (const int64_t step : steps) ++counts[step];
    return std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; })->first;
}

bool isEven(const Numbers& steps) {
    return std::ranges::all_of(steps, [&](int64_t step) { return step == steps.front() && step > 0; });
}

std::string listOfPatterns(const std::vector<std::string>& names, const std::vector<NameParts>& parts) {
    std::map<std::string, std::vector<std::string>> of_pattern;
    for (size_t n = 0; n < names.size(); ++n) of_pattern[parts[n].pattern].push_back(names[n]);
    std::string text;
    size_t listed = 0;
    for (const auto& [pattern, of_it] : of_pattern) {
        if (listed++ == kMostListed) return text + ", ...";
        text += (text.empty() ? "" : ", ") + of_it.front() +
                (of_it.size() > 1 ? " to " + of_it.back() + " (" + std::to_string(of_it.size()) + ")" : "");
    }
    return text;
}

constexpr const char* kOneStack = "; a folder is one stack: move what is not of it into a folder of its own";

// "5 to 7, 12": what steps of that size would have met on the way.
std::string missingNumbers(const Numbers& numbers, int64_t step) {
    std::string text;
    size_t listed = 0;
    for (size_t n = 1; n < numbers.size(); ++n) {
        const int64_t first = numbers[n - 1] + step, last = numbers[n] - step;
        if (first > last) continue;
        if (listed++ == kMostListed) return text + ", ...";
        text += (text.empty() ? "" : ", ") + std::to_string(first) +
                (last > first ? " to " + std::to_string(last) : "");
    }
    return text;
}

// The first names that have this number in common, though perhaps not all of their numbers.
std::string problemOfTwice(const std::vector<std::string>& names, const std::vector<NameParts>& parts,
                           const Numbers& steps) {
    const auto n = size_t(std::ranges::find(steps, 0) - steps.begin());
    const std::string both = names[n] + " and " + names[n + 1];
    if (parts[n].numbers == parts[n + 1].numbers) return both + " have the same number" + kOneStack;
    return "no number in the names of its pictures counts them all (" + both + ", ..., " + names.back() +
           "), as if there were several stacks" + kOneStack;
}

// The names differ by `numbers` first of all, and these are not even.
std::string problemOfColumn(const std::vector<std::string>& names, const std::vector<NameParts>& parts,
                            const Numbers& numbers) {
    const Numbers steps = stepsOf(numbers);
    if (std::ranges::count(steps, 0) > 0) return problemOfTwice(names, parts, steps);
    const int64_t step = usualStep(steps);
    if (std::ranges::any_of(steps, [&](int64_t s) { return s % step != 0; })) {
        const auto other = std::ranges::find_if(steps, [&](int64_t s) { return s % step != 0; });
        const auto n = size_t(other - steps.begin());
        return "the numbers of its pictures do not run evenly (" + names[n] + ", " + names[n + 1] +
               "); number slices that are equally far apart 1, 2, 3 and so on";
    }
    const auto gap =
        size_t(std::ranges::find_if(steps, [&](int64_t s) { return s != step; }) - steps.begin());
    return "slices are missing: number " + missingNumbers(numbers, step) + " (" + names[gap] +
           " is followed by " + names[gap + 1] +
           "); complete the stack, or if none is missing number its files without gaps";
}

}  // namespace

bool isBeforeNaturally(const std::string& a, const std::string& b) {
    size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        const size_t i_end = endOfDigits(a, i), j_end = endOfDigits(b, j);
        if (i_end > i && j_end > j) {
            const std::string_view m = numberAt(a, i, i_end), n = numberAt(b, j, j_end);
            if (m != n) return m.size() != n.size() ? m.size() < n.size() : m < n;
            i = i_end;
            j = j_end;
        } else {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i;
            ++j;
        }
    }
    if (i < a.size() || j < b.size()) return i == a.size();
    return a < b;  // "a01" and "a1"
}

SliceNumbers sliceNumbersOf(const std::vector<std::string>& names) {
    std::vector<NameParts> parts;
    for (const std::string& name : names) parts.push_back(partsOfName(name));
    if (names.size() < 2 || std::ranges::all_of(parts, [](const auto& name) { return name.numbers.empty(); }))
        return {};
    const std::string& pattern = parts.front().pattern;
    if (!std::ranges::all_of(parts, [&](const auto& name) { return name.pattern == pattern; }))
        return {"its pictures have names of several kinds: " + listOfPatterns(names, parts) + kOneStack, {}};
    std::optional<Numbers> first;  // of the columns that are not alike everywhere
    for (size_t place = 0; place < parts.front().numbers.size(); ++place) {
        const Numbers numbers = column(parts, place), steps = stepsOf(numbers);
        if (isEven(steps))
            return {{}, steps.front() > 1 ? "numbered in steps of " + std::to_string(steps.front()) : ""};
        if (!first && std::ranges::any_of(steps, [](int64_t step) { return step != 0; })) first = numbers;
    }
    return {problemOfColumn(names, parts, first.value_or(column(parts, 0))), {}};
}

}  // namespace bonemill
